// Limits what a scene file may name, because scenes come from other people.
#pragma once

#include <string>

#include "config/settings.hpp"

namespace tyndall::config {

// Refuses names that a scene file may not contain: elevations on a network, and a phase function or a cache folder
// outside of the folder of the outermost scene, `folder`. `before` contains the settings before the file was read; what
// the file did not change is accepted. Does nothing with files::outside_allowed().
[[nodiscard]] Result<void> check_names(const Settings& settings, const Settings& before, const std::string& scene_path,
                                       const std::string& folder);

}  // namespace tyndall::config
