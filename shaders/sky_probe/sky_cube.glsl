// The places of texels in the buffers of a sky probe's cube map. Both begin with level 0, and hold the levels one after
// the other; a level holds its six faces, a face its rows. The faces are those of Vulkan (+x, -x, +y, -y, +z, -z).
#ifndef TYNDALL_SKY_CUBE_GLSL
#define TYNDALL_SKY_CUBE_GLSL

#include "lib/half.glsl"

// Returns the index of the first texel of a level. The levels before it have 6 (s^2 + (s / 2)^2 + ...) texels.
uint level_start(uint cube_size, uint level) {
  uint width = cube_size >> level;
  return 8u * (cube_size * cube_size - width * width);
}

// Returns the vector to a point of a face, which is not normalised: the largest component is 1. st: coordinates on the
// face, from -1 to 1 (Vulkan specification, "Cube Map Face Selection").
vec3 face_point(uint face, vec2 st) {
  float side = (face & 1u) == 0u ? 1.0 : -1.0;
  if (face < 2u) return vec3(side, -st.y, -side * st.x);
  if (face < 4u) return vec3(st.x, side, side * st.y);
  return vec3(side * st.x, -st.y, side);
}

// Returns that vector to the centre of the texel `index` of a level with faces of `width` texels.
vec3 texel_point(uint index, uint width) {
  uint in_face = index % (width * width);
  vec2 at = vec2(in_face % width, in_face / width) + 0.5;
  return face_point(index / (width * width), at * (2.0 / float(width)) - 1.0);
}

// Returns the texel of a cube map in half precision.
uvec2 texel_of(vec3 light) {
  vec3 held = min(light, vec3(kLargestHalf));
  return uvec2(packHalf2x16(held.rg), packHalf2x16(vec2(held.b, 1.0)));
}

#endif
