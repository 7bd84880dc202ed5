#include "viewer/viewer.hpp"

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include "files/text.hpp"
#include "gpu/try.hpp"
#include "viewer/platform/display_loss.hpp"
#include "viewer/platform/process_memory.hpp"
#include "viewer/viewer_loop.hpp"

namespace tyndall::viewer {

Result<void> run(const ViewerDesc& desc) {
  configure_malloc();
  TYNDALL_TRY(Window::start());
  Result<void> done;
  std::uint32_t messages = 0;
  std::string text;
  {
    Viewer viewer(desc);
    done = viewer.start();
    if (done) done = viewer.loop();
    if (!done) done = viewer.after_loss(done.error());
    // The error must also be printed if the display is lost only now.
    on_display_loss([done] {
      if (!done) print_error(done.error());
    });
    messages = viewer.devices().validation_messages();
    text = viewer.devices().validation_text();
  }
  if (ImGui::GetCurrentContext() != nullptr) {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
  }
  Window::stop();
  if (done && messages > 0) {
    return Error{ErrorCode::vulkan, "--validation: " + std::to_string(messages) +
                                        " messages of the validation layer; the first: " + files::one_line(text, 1500)};
  }
  return done;
}

}  // namespace tyndall::viewer
