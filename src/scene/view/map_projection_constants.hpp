// The structures of shaders/scene/map_projections.h in C++, with the layout that std430 gives them.
#pragma once

#include <cstddef>

#include "scene/terrain/terrain_constants.hpp"

namespace tyndall::scene::shared {

#include "scene/charts.h"

static_assert(sizeof(ChartLink) == 48 && offsetof(Charts, world_x) == 288 && sizeof(Charts) == 336);

}  // namespace tyndall::scene::shared
