// The structures of shaders/scene/terrain.h in C++, with the layout that std430 gives them.
#pragma once

#include <cstddef>

#include "scene/view/shader_types.hpp"

namespace tyndall::scene::shared {

#include "scene/terrain.h"

static_assert(sizeof(TerrainLevel) == 24 && offsetof(TerrainConstants, direction_to_sun) == 16);
static_assert(offsetof(TerrainConstants, shadow_from_local) % 16 == 0);
static_assert(offsetof(TerrainConstants, levels) % 16 == 0 && sizeof(TerrainConstants) % 16 == 0);

}  // namespace tyndall::scene::shared
