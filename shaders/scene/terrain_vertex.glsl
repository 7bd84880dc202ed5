// The vertices of a block of terrain, for the view and for the shadow maps. The grid morphs into the next coarser one
// near the end of its level's range: see src/scene/terrain/terrain_lod.hpp.
#ifndef TYNDALL_TERRAIN_VERTEX_GLSL
#define TYNDALL_TERRAIN_VERTEX_GLSL

#include "scene/map_projections.glsl"
#include "scene/terrain.h"

layout(std430, binding = 0) readonly buffer terrain_block { TerrainConstants terrain; };
layout(std430, binding = 1) readonly buffer blocks_block { ivec4 blocks[]; };
layout(binding = 2) uniform sampler2DArray terrain_heights;

layout(push_constant) uniform Push {
  mat4 clip_from_local;
  uint first_block;
}
push;

struct TerrainVertex {
  vec3 position;  // in the local frame
  float altitude_m;
  vec2 texel;  // in the level's texture
  vec2 parent_texel;
  float morph;
  uint layer;
};

TerrainVertex terrain_vertex(uint vertex, uint instance) {
  ivec4 block = blocks[push.first_block + instance];
  uint layer = uint(block.z);
  TerrainLevel level = terrain.levels[layer];
  uint side = terrain.block_cells + 1u;
  ivec2 grid = block.xy + ivec2(vertex % side, vertex / side);
  ivec2 even = grid & ~1;

  vec2 offset = vec2(grid - level.origin) * level.cell_m + level.first_m - terrain.camera_map;
  float away = sqrt(dot(offset, offset) + terrain.vertical_m * terrain.vertical_m);
  float morph = clamp((away - 0.75 * level.range_m) / (0.2 * level.range_m), 0.0, 1.0);
  if (layer + 1u == terrain.layers) morph = 0.0;
  uint parent = min(layer + 1u, terrain.layers - 1u);

  TerrainVertex v;
  v.layer = layer;
  v.morph = morph;
  float own = texelFetch(terrain_heights, ivec3(grid - level.origin, int(layer)), 0).r;
  ivec2 parent_grid = (even >> 1) - terrain.levels[parent].origin;
  float coarse = morph > 0.0 ? texelFetch(terrain_heights, ivec3(parent_grid, int(parent)), 0).r : own;
  v.altitude_m = mix(own, coarse, morph);
  vec2 slid = mix(vec2(grid), vec2(even), morph);
  v.texel = slid - vec2(level.origin) + 0.5;
  v.parent_texel = slid * 0.5 - vec2(terrain.levels[parent].origin) + 0.5;
  v.position =
      local_position(local_direction((slid - vec2(level.origin)) * level.cell_m + level.first_m), v.altitude_m);
  return v;
}

#endif
