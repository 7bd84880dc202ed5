// `tyndall params`: prints every parameter as a scene file, JSON or Markdown.
#include "arguments.hpp"
#include "cli.hpp"
#include "config/describe.hpp"
#include "config/scene_file.hpp"

namespace tyndall::cli {

int run_params(Args args) {
  CommonOptions common;
  std::string format = "toml";
  Arguments arguments("params");
  add_common(arguments, common, kScene | kSet);
  arguments.choice("--format", format, {"toml", "json", "markdown"}, "format of the list");
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  if (const Result<void> resolved = resolve(common); !resolved) return fail(resolved.error());
  if (format == "json") return print(config::to_json(common.settings));
  if (format == "markdown") return print(config::to_markdown());
  return print(config::to_toml(common.settings));
}

}  // namespace tyndall::cli
