// What terrain_heights.comp reads: the source of elevations and the part of a clipmap level to fill.
// Compiled by GLSL (std430) and by C++ (src/scene/elevation/elevation_source.hpp): every member is four
// bytes, vectors of two are at multiples of eight.
#ifndef TYNDALL_TERRAIN_FILL_H
#define TYNDALL_TERRAIN_FILL_H

struct TerrainSource {
  ivec2 raster_size;       // samples of the elevation file; 0 0 for procedural terrain
  float raster_spacing_m;  // its centre is at the origin of the map
  float raster_min_m;      // lowest and highest sample
  float raster_max_m;
  float outside_offset_m;  // raises the procedural terrain around the file to the level of its border
  uint kind;               // 0 procedural, 1 file
  uint seed;
  float exaggeration;
  int raster_levels;  // levels of detail in the atlas, see terrain_source.glsl
};

// Texel texel_offset + t of the layer, t in [0; texel_count), is the sample first_sample + t of the level,
// at (first_sample + t) * spacing_m on the map; texel numbers are taken modulo texel_mask + 1, a power of two
// (for levels that wrap round), or as they are with texel_mask = -1.
struct TerrainFill {
  TerrainSource source;
  ivec2 first_sample;
  ivec2 texel_offset;
  ivec2 texel_count;
  float spacing_m;  // a multiple of 1/64 m
  int texel_mask;
  int layer;
  int unused;
  vec2 first_m;  // place of first_sample from the origin of the local frame, on the map
};

#endif
