// Fills a rectangle of one level of the elevation clipmap.
// In: the source and the rectangle (terrain_fill.h), in a storage buffer: this is read per invocation, as
// some drivers mishandle branches on uniform buffers; the atlas of the elevation file (terrain_source.glsl;
// any 1 x 1 image for procedural terrain). Out: elevation in m, one layer of the clipmap.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 1) uniform sampler2D elevation_atlas;
#define TERRAIN_RASTER(source, texel) texelFetch(elevation_atlas, texel, 0).r
#include "scene/terrain_source.glsl"

layout(std430, binding = 0) readonly buffer terrain_fill_block { TerrainFill fill; };
layout(binding = 2, r32f) uniform writeonly image2DArray elevation_levels;

void main() {
  ivec2 t = ivec2(gl_GlobalInvocationID.xy);
  if (t.x >= fill.texel_count.x || t.y >= fill.texel_count.y) return;
  int sample_units = int(fill.spacing_m * kTerrainUnitsPerM + 0.5);
  // A little more than the spacing: a crest as narrow as one cell would be cut into teeth by the grid.
  float height_m =
      terrain_source_height(fill.source, (fill.first_sample + t) * sample_units, 1.25 * fill.spacing_m);
  ivec2 texel = (fill.texel_offset + t) & fill.texel_mask;
  imageStore(elevation_levels, ivec3(texel, fill.layer), vec4(height_m, 0.0, 0.0, 0.0));
}
