// The types of the structures that C++ shares with the shaders of the scene (std430). A vec3 is three floats, aligned
// to four bytes.
#pragma once

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

}  // namespace tyndall::scene::shared
