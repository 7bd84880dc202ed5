// The input of terrain_heights.comp: the source of elevations and the levels of the clipmap. Compiled as GLSL
// (std430) and as C++ (src/scene/elevation/elevation_source.hpp): every member has four bytes, and vectors of two are
// at multiples of eight.
#ifndef TYNDALL_TERRAIN_FILL_H
#define TYNDALL_TERRAIN_FILL_H

struct TerrainSource {
  ivec2 raster_size;       // samples of the elevation file; 0 0 for procedural terrain
  float raster_spacing_m;  // distance between samples; the centre of the file is at the origin of the map
  float raster_min_m;      // lowest and highest sample
  float raster_max_m;
  float outside_offset_m;  // raises the procedural terrain around the file to the level of the file's border
  uint kind;               // 0 procedural, 1 file
  uint seed;
  float exaggeration;
  int raster_levels;  // levels of detail in the atlas, see terrain_source.glsl
};

// A level of the clipmap. Texel t holds sample first_sample + t, at (first_sample + t) * spacing_m on the map.
struct TerrainFillLevel {
  ivec2 first_sample;
  vec2 first_m;     // map position of first_sample relative to the origin of the local frame
  float spacing_m;  // a multiple of 1/64 m
  int unused;
};

struct TerrainFill {
  TerrainSource source;
  TerrainFillLevel levels[16];
};

#endif
