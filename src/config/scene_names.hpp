// Limits what a scene file may name, because scenes come from other people.
#pragma once

#include <string>

#include "config/settings.hpp"

namespace tyndall::config {

// Refuses what a scene file may not name by itself: a network, tables outside of the folder of the outermost scene, and
// a place outside of it for new files. `before` are the settings before the file was read; `folder` is that of the
// outermost scene. Does nothing with files::outside_allowed().
[[nodiscard]] Result<void> check_names(const Settings& settings, const Settings& before, const std::string& scene_path,
                                       const std::string& folder);

}  // namespace tyndall::config
