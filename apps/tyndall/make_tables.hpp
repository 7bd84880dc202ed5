// Describes how the verbs build tables: with the cache that the settings name, and with a progress bar.
#pragma once

#include <memory>

#include "cli.hpp"
#include "scene/description/scene_params.hpp"
#include "tables/make_ready.hpp"

namespace tyndall::cli {

[[nodiscard]] tables::CacheDesc table_cache(const scene::SceneParams& scene);
// Returns the description of a build with this cache and a progress bar, which disappears when the tables are complete.
[[nodiscard]] tables::MakeReady make_tables(const scene::SceneParams& scene);

}  // namespace tyndall::cli
