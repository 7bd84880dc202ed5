// Replaces `tyndall view` in a build without GLFW and ImGui.
#include "cli.hpp"
#include "verbs.hpp"

namespace tyndall::cli {

bool has_viewer() { return false; }
bool has_shader_reload() { return false; }

int run_view(Args /*args*/) {
  return fail(
      "tyndall view: built without the viewer; no window can be opened; expected a program built with GLFW and ImGui",
      kBadUsage);
}

}  // namespace tyndall::cli
