// The structures of shaders/scene/terrain.h in C++, with the layout that std430 gives them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tyndall/types.hpp"

namespace tyndall::scene::shared {

struct ivec2 {
  std::int32_t x = 0, y = 0;
};
struct vec2 {
  float x = 0.0F, y = 0.0F;
};
struct vec4 {
  float x = 0.0F, y = 0.0F, z = 0.0F, w = 0.0F;
};
using vec3 = Vec3;
using mat4 = Mat4;
using uint = std::uint32_t;

#include "scene/terrain.h"

static_assert(sizeof(TerrainLevel) == 24 && offsetof(TerrainConstants, direction_to_sun) == 16);
static_assert(offsetof(TerrainConstants, shadow_from_local) % 16 == 0);
static_assert(offsetof(TerrainConstants, levels) % 16 == 0 && sizeof(TerrainConstants) % 16 == 0);

}  // namespace tyndall::scene::shared
