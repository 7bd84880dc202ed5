#include "terrain_float.hpp"

#include <glm/glm.hpp>

namespace tyndall::scene::terrain32 {
namespace {

using uint = std::uint32_t;
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
using ivec2 = glm::ivec2;
using uvec2 = glm::uvec2;
using uvec4 = glm::uvec4;
using glm::abs;
using glm::clamp;
using glm::dot;
using glm::floor;
using glm::inversesqrt;
using glm::max;
using glm::min;
using glm::mix;
using glm::smoothstep;
using glm::sqrt;

#define INOUT(type) type&
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "scene/terrain_noise.glsl"
#pragma GCC diagnostic pop
#undef INOUT

}  // namespace

float height_at(std::int32_t x, std::int32_t z, float spacing_m, std::uint32_t seed) {
  return terrain_height_at(ivec2(x, z), spacing_m, seed);
}

}  // namespace tyndall::scene::terrain32
