// How the verbs make tables: with the cache that the settings name, and a progress bar while they are built.
#pragma once

#include <memory>

#include "cli.hpp"
#include "scene/description/scene_params.hpp"
#include "tables/make_ready.hpp"

namespace tyndall::cli {

[[nodiscard]] tables::CacheDesc table_cache(const scene::SceneParams& scene);
// The same with the bar, which is gone when the tables are complete.
[[nodiscard]] tables::MakeReady make_tables(const scene::SceneParams& scene);

}  // namespace tyndall::cli
