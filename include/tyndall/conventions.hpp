// Conversions from the conventions of other engines to those of Tyndall: right-handed, y up, a view that looks down -z,
// clip space with y down and depth 0 to 1. All functions are constexpr and need no library. Matrices are column-major
// and multiply column vectors; transpose those of engines with row vectors first.
//
// An engine with axes of its own states them once, as the matrix `world` from its world to Tyndall's, and `view` from
// its view to Tyndall's:
//   camera.world_from_view = world_from_view(world, engine_world_from_view, view);
//   camera.clip_from_view = clip_from_view(engine_clip_from_view, view);
//   cascade.shadow_from_world = shadow_from_world(engine_shadow_from_world, world);
//   sun.direction_to_sun = direction(world, engine_direction_to_sun);
// The results are pictures, so nothing has to be converted back to the engine's axes.
#pragma once

#include "tyndall/types.hpp"

namespace tyndall::conventions {

// Returns a * b.
[[nodiscard]] constexpr Mat4 product(const Mat4& a, const Mat4& b) {
  Mat4 out;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      float sum = 0.0F;
      for (int i = 0; i < 4; ++i) sum += a.m[4 * i + row] * b.m[4 * column + i];
      out.m[4 * column + row] = sum;
    }
  }
  return out;
}

// Matrices from the axes of an engine. Each is a rotation or a reflection, so that its inverse is its transpose.
// Right-handed, y up: the axes of Tyndall. Also the view of OpenGL, Vulkan samples and glTF, which looks down -z.
inline constexpr Mat4 kSame = {};
// Right-handed, z up, x east, y north: (x, y, z) becomes (x, z, -y).
inline constexpr Mat4 kZUp = {{1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1}};
// Left-handed, y up, x east, z north: (x, y, z) becomes (x, y, -z). Also a left-handed view that looks down +z with y
// up.
inline constexpr Mat4 kLeftHanded = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1}};
// Left-handed, z up, x north, y east: (x, y, z) becomes (y, z, -x). Also a view that looks along +x with z up.
inline constexpr Mat4 kLeftHandedZUp = {{0, 0, -1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1}};
// A right-handed view that looks down +z with y down, as in computer vision: (x, y, z) becomes (x, -y, -z).
inline constexpr Mat4 kLooksDownZ = {{1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1}};

// Returns the inverse of a rotation or a reflection without translation, such as those above.
[[nodiscard]] constexpr Mat4 transposed(const Mat4& m) {
  Mat4 out;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) out.m[4 * row + column] = m.m[4 * column + row];
  }
  return out;
}

// Returns a direction in the world of Tyndall.
[[nodiscard]] constexpr Vec3 direction(const Mat4& world, const Vec3& d) {
  const float* const m = world.m;
  return {m[0] * d.x + m[4] * d.y + m[8] * d.z, m[1] * d.x + m[5] * d.y + m[9] * d.z,
          m[2] * d.x + m[6] * d.y + m[10] * d.z};
}

// Return the matrices of Camera and Cascade.
[[nodiscard]] constexpr Mat4 world_from_view(const Mat4& world, const Mat4& engine_world_from_view, const Mat4& view) {
  return product(world, product(engine_world_from_view, transposed(view)));
}
[[nodiscard]] constexpr Mat4 clip_from_view(const Mat4& engine_clip_from_view, const Mat4& view) {
  return product(engine_clip_from_view, transposed(view));
}
[[nodiscard]] constexpr Mat4 shadow_from_world(const Mat4& engine_shadow_from_world, const Mat4& world) {
  return product(engine_shadow_from_world, transposed(world));
}

// Returns a projection for clip space with y down, from one with y up, such as those of OpenGL and Direct3D. It is
// needed if the first row of your picture is its top, as with a viewport of negative height.
[[nodiscard]] constexpr Mat4 y_flipped(const Mat4& clip_from_view) {
  Mat4 out = clip_from_view;
  for (int column = 0; column < 4; ++column) out.m[4 * column + 1] = -out.m[4 * column + 1];
  return out;
}

// Returns a projection with depth from 0 to 1, from one with depth from -1 to 1. The depth image must have been written
// with the default of glDepthRange, which maps depth in the same way.
[[nodiscard]] constexpr Mat4 depth_from_opengl(const Mat4& clip_from_view) {
  Mat4 out = clip_from_view;
  for (int column = 0; column < 4; ++column) {
    out.m[4 * column + 2] = 0.5F * (clip_from_view.m[4 * column + 2] + clip_from_view.m[4 * column + 3]);
  }
  return out;
}

// Returns a matrix to texture coordinates and depth, 0 to 1, from one to clip space (x and y from -1 to 1, depth from 0
// to 1), whose first row of texels is at y = -1.
[[nodiscard]] constexpr Mat4 texture_from_clip(const Mat4& clip_from_world) {
  constexpr Mat4 kHalf = {{0.5F, 0, 0, 0, 0, 0.5F, 0, 0, 0, 0, 1, 0, 0.5F, 0.5F, 0, 1}};
  return product(kHalf, clip_from_world);
}

}  // namespace tyndall::conventions
