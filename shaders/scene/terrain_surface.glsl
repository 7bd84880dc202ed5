// The shape of the ground at a pixel, and how much of the sky it sees, from the clipmap.
#ifndef TYNDALL_TERRAIN_SURFACE_GLSL
#define TYNDALL_TERRAIN_SURFACE_GLSL

#include "scene/terrain.h"

layout(std430, binding = 0) readonly buffer terrain_block { TerrainConstants terrain; };
layout(binding = 2) uniform sampler2DArray terrain_heights;

float height_at(ivec2 texel, uint layer) { return texelFetch(terrain_heights, ivec3(texel, int(layer)), 0).r; }

// Returns the gradient of the elevation in map coordinates (xy), and the change of slope over a cell (z), which is
// positive in hollows. Central differences at the four surrounding samples are interpolated linearly, so that the
// result is continuous across cells.
vec3 surface_shape(vec2 texel, uint layer) {
  vec2 base = floor(texel - 0.5);
  vec2 f = texel - 0.5 - base;
  ivec2 b = ivec2(base);
  vec3 g[4];
  for (int i = 0; i < 4; ++i) {
    ivec2 at = b + ivec2(i & 1, i >> 1);
    float east = height_at(at + ivec2(1, 0), layer);
    float west = height_at(at - ivec2(1, 0), layer);
    float south = height_at(at + ivec2(0, 1), layer);
    float north = height_at(at - ivec2(0, 1), layer);
    g[i] = vec3(east - west, south - north, east + west + south + north - 4.0 * height_at(at, layer));
  }
  vec3 mixed = mix(mix(g[0], g[1], f.x), mix(g[2], g[3], f.x), f.y);
  return mixed / (2.0 * terrain.levels[layer].cell_m);
}

// Returns the elevation at a map position from the finest level with cells of at least `cell_m`, but none finer than
// `layer`: finer levels may end before this position.
float coarse_height(vec2 offset_m, float cell_m, uint layer) {
  while (layer + 1u < terrain.layers && terrain.levels[layer].cell_m < cell_m) ++layer;
  TerrainLevel level = terrain.levels[layer];
  ivec2 texel = ivec2(floor((offset_m - level.first_m) / level.cell_m + 0.5));
  return height_at(clamp(texel, ivec2(0), ivec2(textureSize(terrain_heights, 0).xy) - 1), layer);
}

// Returns the fraction of the sky's irradiance that the surrounding ground does not block: the mean of cos^2 of the
// horizon's elevation in eight directions, found at three distances. It is exact for a uniform sky. `layer`: the level
// of the point. The texels that are read here must be those in src/scene/terrain/terrain_tiles.cpp.
float sky_visibility(vec2 offset_m, float altitude_m, uint layer) {
  float visible = 0.0;
  for (int i = 0; i < 8; ++i) {
    float angle = 0.785398 * (float(i) + 0.5);
    vec2 direction = vec2(cos(angle), sin(angle));
    float tangent = 0.0;
    float reach = 200.0;
    for (int k = 0; k < 3; ++k) {
      float height_m = coarse_height(offset_m + direction * reach, 0.125 * reach, layer);
      tangent = max(tangent, (height_m - altitude_m) / reach);
      reach *= 4.0;
    }
    visible += 1.0 / (1.0 + tangent * tangent);
  }
  return visible / 8.0;
}

#endif
