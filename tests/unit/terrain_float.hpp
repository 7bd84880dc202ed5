// shaders/scene/terrain_noise.glsl compiled as C++ in single precision, as on the GPU.
#pragma once

#include <cstdint>

namespace tyndall::scene::terrain32 {

// Returns the elevation at a position in units of 1/64 m.
float height_at(std::int32_t x, std::int32_t z, float spacing_m, std::uint32_t seed);

}  // namespace tyndall::scene::terrain32
