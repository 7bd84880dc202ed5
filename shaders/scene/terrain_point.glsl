// A ground point packed into four floats: the texel of the level's texture, altitude [m], and level and morph in one
// number, which is negative where there is ground. Texels are precise where a map position far from the origin would
// not be.
#ifndef TYNDALL_TERRAIN_POINT_GLSL
#define TYNDALL_TERRAIN_POINT_GLSL

vec4 pack_ground_point(vec2 texel, float altitude_m, uint layer, float morph) {
  // The sum stays away from whole numbers, so that rounding cannot change the level. The clamp is needed because a
  // value interpolated over a triangle seen edge-on may lie beyond those of its vertices.
  return vec4(texel, altitude_m, -(2.0 * float(layer) + 0.5 + clamp(morph, 0.0, 1.0)));
}

bool is_ground_point(vec4 stored) { return stored.w < 0.0; }

void unpack_level(vec4 stored, out uint layer, out float morph) {
  float both = -stored.w;
  float twice = 2.0 * floor(0.5 * both);
  layer = uint(0.5 * twice);
  morph = clamp(both - twice - 0.5, 0.0, 1.0);
}

#endif
