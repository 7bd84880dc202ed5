// The elevation shaders compiled as C++ in double precision. The namespace tyndall::scene::terrain64 contains all
// functions of shaders/scene/terrain_noise.glsl, terrain_source.glsl and terrain_materials.glsl, with vec2 =
// glm::dvec2. Include it in .cpp files only, because it defines functions of internal linkage.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace tyndall::scene::terrain64 {

using uint = std::uint32_t;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using ivec2 = glm::ivec2;
using uvec2 = glm::uvec2;
using uvec4 = glm::uvec4;
using Sample = float;

using glm::abs;
using glm::clamp;
using glm::dot;
using glm::floor;
using glm::inversesqrt;
using glm::length;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::smoothstep;
using glm::sqrt;

#ifdef __clang__
#pragma clang diagnostic ignored "-Wkeyword-macro"
#endif
#define float double
#define INOUT(type) type&
#undef TYNDALL_TERRAIN_FILL_H
#include "scene/terrain_fill.h"

// A source and its atlas, which is a separate texture in GLSL.
struct BoundSource : TerrainSource {
  const Sample* atlas = nullptr;
  int atlas_width = 0;
};

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace {
#define TERRAIN_RASTER(source, texel) source.atlas[static_cast<std::size_t>((texel).y) * source.atlas_width + (texel).x]
#define TERRAIN_SOURCE const BoundSource&
#include "scene/terrain_materials.glsl"
#include "scene/terrain_source.glsl"
#undef TERRAIN_SOURCE
#undef TERRAIN_RASTER
}  // namespace
#pragma GCC diagnostic pop

#undef INOUT
#undef float

}  // namespace tyndall::scene::terrain64
