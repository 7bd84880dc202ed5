#include "config/scene_names.hpp"

#include <filesystem>
#include <string_view>
#include <system_error>

#include "files/access.hpp"
#include "files/text.hpp"

namespace tyndall::config {
namespace {

// Returns whether a name of GDAL uses a network: a URL, or a virtual file system other than those of archives.
bool names_network(std::string_view name) {
  for (std::size_t at = name.find("/vsi"); at != std::string_view::npos; at = name.find("/vsi", at + 1)) {
    const std::string_view rest = name.substr(at + 4);
    if (!rest.starts_with("zip/") && !rest.starts_with("gzip/") && !rest.starts_with("tar/")) return true;
  }
  return name.find("://") != std::string_view::npos;
}

// Returns whether a folder is in use as a cache, or exists and is empty.
bool can_be_cache(const std::string& folder) {
  std::error_code failed;
  bool cached = false, others = false;
  for (std::filesystem::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    if (it->path().filename().string().starts_with(".tyndall-")) continue;  // a process is filling the cache
    const bool ours = it->path().extension() == ".cache";
    cached = cached || ours;
    others = others || !ours;
  }
  return !failed && (cached || !others);
}

}  // namespace

Result<void> check_names(const Settings& settings, const Settings& before, const std::string& scene_path,
                         const std::string& folder) {
  if (files::outside_allowed()) return {};
  const auto refuse = [&](std::string_view key, std::string_view value, std::string_view what,
                          std::string_view expected) {
    return files::input_error(files::concat({key, " '", files::one_line(value, 200), "' ", what}),
                              files::one_line(scene_path, 200), files::concat({expected, ", or --allow-outside"}));
  };
  const std::string& source = settings.scene.terrain.source;
  if (source != before.scene.terrain.source && names_network(source))
    return refuse("terrain.source", source, "is on a network", "expected a local file");
  for (const Row& row : rows()) {
    // Elevations and models may be anywhere. They are only drawn.
    if (row.info.type != ParamType::string || row.info.unit != "file" || row.info.name == "source") continue;
    const std::string value = value_text(row, settings);
    if (value.empty() || value == value_text(row, before)) continue;
    if (!files::is_within(value, folder) && !files::is_within(value, "."))
      return refuse(row.key(), value, "is outside the folder of the scene",
                    "expected a file in that folder or below it");
  }
  const std::string& cache = settings.scene.tables.cache;
  if (cache == before.scene.tables.cache || cache.empty() || cache == "auto" || cache == "off") return {};
  if (files::is_within(cache, folder) || files::is_within(cache, ".") || can_be_cache(cache)) return {};
  return refuse("tables.cache", cache, "is outside the folder of the scene",
                "expected auto, off, a folder below that of the scene or the working directory, or one that is in use "
                "as a cache");
}

}  // namespace tyndall::config
