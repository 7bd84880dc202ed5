// `tyndall devices`: lists the Vulkan devices, the one that would be used, and what the others lack.
#include <nlohmann/json.hpp>

#include "arguments.hpp"
#include "cli.hpp"
#include "gpu/host.hpp"

namespace tyndall::cli {
namespace {

std::string version_text(std::uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

}  // namespace

int run_devices(Args args) {
  CommonOptions options;
  Arguments arguments("devices");
  add_common(arguments, options, kDevice | kJson);
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  const Result<std::vector<gpu::DeviceRow>> rows = gpu::Host::list(options.device);
  if (!rows) return fail(rows.error());
  if (options.json) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const gpu::DeviceRow& row : rows.value()) {
      out.push_back({{"name", row.name},
                     {"type", gpu::type_name(row.type)},
                     {"driver", row.driver},
                     {"vulkan", version_text(row.api_version)},
                     {"missing", row.missing},
                     {"graphics", row.graphics},
                     {"used", row.chosen}});
    }
    return print(out.dump(2) + "\n");
  }
  std::string text;
  for (std::size_t i = 0; i < rows.value().size(); ++i) {
    const gpu::DeviceRow& row = rows.value()[i];
    text += std::string(row.chosen ? "* " : "  ") + std::to_string(i) + "  " + row.name + "  (" +
            gpu::type_name(row.type) + ", Vulkan " + version_text(row.api_version) + ", " + row.driver + ")";
    if (!row.graphics) text += "  computes only: probe, sky, tables and validate";
    for (std::size_t k = 0; k < row.missing.size(); ++k) text += (k == 0 ? "  lacks " : ", ") + row.missing[k];
    text += "\n";
  }
  return print(text);
}

}  // namespace tyndall::cli
