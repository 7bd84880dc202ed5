// Fills tiles of the elevation clipmap, one per workgroup in z.
// In: the source and the levels (terrain_fill.h), the tiles (TerrainTile of src/scene/terrain/terrain_tiles.hpp), and
// the atlas of the elevation file (terrain_source.glsl; any 1 x 1 image for procedural terrain). The constants are in a
// storage buffer because some drivers mishandle branches on uniform buffers. Out: elevation in m.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 1) uniform sampler2D elevation_atlas;
#define TERRAIN_RASTER(source, texel) texelFetch(elevation_atlas, texel, 0).r
#include "scene/terrain_source.glsl"
#include "scene/map_projections.glsl"

layout(std430, binding = 0) readonly buffer terrain_fill_block { TerrainFill fill; };
layout(std430, binding = 3) readonly buffer tiles_block { ivec4 tiles[]; };
layout(binding = 2, r32f) uniform writeonly image2DArray elevation_levels;

void main() {
  ivec4 tile = tiles[gl_WorkGroupID.z];
  TerrainFillLevel level = fill.levels[tile.z];
  ivec2 t = tile.xy + ivec2(gl_GlobalInvocationID.xy);
  int sample_units = int(level.spacing_m * kTerrainUnitsPerM + 0.5);
  // Slightly more than the spacing: the grid would give a jagged edge to a crest as narrow as one cell.
  float spacing_m = 1.25 * level.spacing_m;
  ivec2 units = (level.first_sample + t) * sample_units;
  // The elevation at a point of the planet is that of its map projection; between map projections it is their weighted
  // mean. Where the file lies, only the file counts. ground_height() of src/scene/terrain/terrain.cpp does the same.
  vec3 direction = local_direction(level.first_m + vec2(t) * level.spacing_m);
  float weights[6];
  uint rest = projection_weights(direction, weights);
  ivec2 map_units = map_projections.own == 0u ? units : ivec2(0);
  bool by_map = weights[0] > 0.0 || fill.source.kind != 0u;
  if (by_map && map_projections.own != 0u) map_units = projection_units(0u, direction);
  float file = fill.source.kind != 0u ? terrain_file_weight(fill.source, map_units) : 0.0;
  if (file > 0.0) rest = file < 1.0 ? rest | 1u : 1u;
  float height_m = 0.0;
  while (rest != 0u) {
    uint projection = uint(findLSB(rest));
    rest &= rest - 1u;
    float weight = (1.0 - file) * weights[projection] + (projection == 0u ? file : 0.0);
    ivec2 at = projection == 0u                    ? map_units
               : projection == map_projections.own ? units
                                                   : projection_units(projection, direction);
    height_m += weight * terrain_projection_height(fill.source, projection, at, spacing_m);
  }
  imageStore(elevation_levels, ivec3(t, tile.z), vec4(height_m, 0.0, 0.0, 0.0));
}
