// `tyndall view`: starts the interactive viewer (apps/viewer).
#include "arguments.hpp"
#include "cli.hpp"
#include "make_tables.hpp"
#include "viewer/shader_reload.hpp"
#include "viewer/viewer.hpp"

namespace tyndall::cli {

bool has_viewer() { return true; }
bool has_shader_reload() { return viewer::ShaderReload::supported(); }

int run_view(Args args) {
  CommonOptions options;
  viewer::ViewerDesc desc;
  Arguments arguments("view");
  add_common(arguments, options, kScene | kSet | kDevice | kSize);
  arguments.text("--state", desc.state_file, "FILE",
                 "state file that F5 saves and F9 loads [~/.local/state/tyndall/view.toml]");
  arguments.text("--screenshots", desc.screenshots, "FOLDER", "folder for the pictures of F12 [the working directory]");
  arguments.text("--log", desc.log, "FILE", "write events to this file, one per line");
  arguments.text("--script", desc.script, "WHAT",
                 "for tests: walk, soak=SECONDS, soak-frames=COUNT, lose-surface, lose-device or one-device");
  bool no_first_steps = false;
  arguments.flag("--no-first-steps", no_first_steps, "do not show the help text of the first run");
  arguments.flag("--validation", desc.validation,
                 "enable the Vulkan validation layer; exit with status 1 if it reports anything");
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  if (Result<void> r = resolve(options); !r) return fail(r.error());
  desc.settings = options.settings;
  desc.width = options.size.width;
  desc.height = options.size.height;
  desc.device = options.device;
  desc.make_tables.cache = table_cache(options.settings.scene);
  desc.first_steps = !no_first_steps;
  if (Result<void> r = viewer::run(desc); !r) return fail(r.error());
  return kDone;
}

}  // namespace tyndall::cli
