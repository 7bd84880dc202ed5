// A place on the ground in four floats, as the terrain is drawn and as it is lit: texel of the level's texture,
// altitude [m], and level and morph together, below zero where there is ground. Texels keep the digits that a place on
// the map would lose far from the origin.
#ifndef TYNDALL_TERRAIN_POINT_GLSL
#define TYNDALL_TERRAIN_POINT_GLSL

vec4 pack_ground_point(vec2 texel, float altitude_m, uint layer, float morph) {
  // Between whole numbers, so that rounding does not lead to another level. What is interpolated over a triangle that
  // is seen edge-on may lie beyond its vertices.
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
