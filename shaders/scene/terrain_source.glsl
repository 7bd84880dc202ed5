// Elevation from a source, procedural or an elevation file, at any point and sample spacing. Functions only; compiles
// as GLSL and as C++, like terrain_noise.glsl. The including file defines TERRAIN_RASTER(source, texel), which reads
// the file's atlas at an ivec2.
//
// The atlas holds the file's samples at (0, 0), north row first. Every further level of detail is a 2 x 2 mean of the
// previous one with sizes rounded up. These levels form a column to the right, from the top down.
#ifndef TYNDALL_TERRAIN_SOURCE_GLSL
#define TYNDALL_TERRAIN_SOURCE_GLSL

#include "scene/terrain_fill.h"
#include "scene/terrain_noise.glsl"

// The type of a source; C++ passes the atlas along with it.
#ifndef TERRAIN_SOURCE
#define TERRAIN_SOURCE TerrainSource
#endif

// The fraction of the file's width over which it blends into procedural terrain at each border.
const float kRasterBorder = 0.2;
// The strength of the gullies added below a file's own resolution, relative to procedural mountains.
const float kRasterDetail = 0.5;

// Returns the weights of four samples for a point `t` between the middle two; terrain_spline_slope() returns their
// derivatives by t (Catmull and Rom, "A class of local interpolating splines", 1974). The curve passes through the
// samples with continuous slopes.
vec4 terrain_spline(float t) {
  return vec4(t * (t * (1.0 - 0.5 * t) - 0.5), t * t * (1.5 * t - 2.5) + 1.0, t * (t * (2.0 - 1.5 * t) + 0.5),
              t * t * (0.5 * t - 0.5));
}
vec4 terrain_spline_slope(float t) {
  return vec4(t * (2.0 - 1.5 * t) - 0.5, t * (4.5 * t - 5.0), t * (4.0 - 4.5 * t) + 0.5, t * (1.5 * t - 1.0));
}

// Returns the file at a map position in m, from level of detail `lod`: x is elevation, yz the gradient.
vec3 terrain_raster(TERRAIN_SOURCE source, vec2 map_m, int lod) {
  ivec2 corner = ivec2(0, 0);
  ivec2 size = source.raster_size;
  for (int level = 0; level < lod; ++level) {
    corner = level == 0 ? ivec2(size.x, 0) : ivec2(corner.x, corner.y + size.y);
    size = ivec2((size.x + 1) / 2, (size.y + 1) / 2);
  }
  float texel_m = source.raster_spacing_m * float(1 << lod);
  vec2 base = map_m / source.raster_spacing_m + vec2(source.raster_size) * 0.5;
  vec2 u = base / float(1 << lod) - vec2(0.5, 0.5);
  vec2 whole = floor(u);
  vec2 f = u - whole;
  ivec2 first = ivec2(whole) - ivec2(1, 1);
  vec4 wx = terrain_spline(f.x);
  vec4 wy = terrain_spline(f.y);
  vec4 dx = terrain_spline_slope(f.x);
  vec4 dy = terrain_spline_slope(f.y);
  vec3 sum = vec3(0.0, 0.0, 0.0);
  for (int j = 0; j < 4; ++j) {
    int y = corner.y + clamp(first.y + j, 0, size.y - 1);
    vec4 row = vec4(TERRAIN_RASTER(source, ivec2(corner.x + clamp(first.x, 0, size.x - 1), y)),
                    TERRAIN_RASTER(source, ivec2(corner.x + clamp(first.x + 1, 0, size.x - 1), y)),
                    TERRAIN_RASTER(source, ivec2(corner.x + clamp(first.x + 2, 0, size.x - 1), y)),
                    TERRAIN_RASTER(source, ivec2(corner.x + clamp(first.x + 3, 0, size.x - 1), y)));
    float value = dot(row, wx);
    sum += vec3(value * wy[j], dot(row, dx) * wy[j], value * dy[j]);
  }
  return vec3(sum.x, sum.y / texel_m, sum.z / texel_m);
}

// Returns the file's elevation with gullies added below its resolution, in proportion to its slope: water stays flat.
float terrain_raster_height(TERRAIN_SOURCE source, ivec2 units, vec2 map_m, float spacing_m) {
  float ratio = spacing_m / source.raster_spacing_m;
  int lod = clamp(int(floor(log2(ratio) + 0.5)), 0, source.raster_levels - 1);
  vec3 raster = terrain_raster(source, map_m, lod);
  TerrainSurface s;
  s.height_m = raster.x;
  s.slope = vec2(raster.y, raster.z);
  s.crest = 0.0;
  if (ratio < 1.0) {
    uint salt = terrain_salt(source.seed);
    TerrainPoint point;
    point.units = units;
    point.warp_m = terrain_warp(units, salt);
    point.spacing_m = spacing_m;
    point.detail_m = 2.0 * source.raster_spacing_m;
    terrain_gullies(s, point, kRasterDetail, salt);
  }
  float margin_m = 0.2 * source.raster_spacing_m;
  return clamp(s.height_m, source.raster_min_m - margin_m, source.raster_max_m + margin_m);
}

// Returns the weight of the file: 1 inside, 0 outside, and a smooth transition along its border.
float terrain_file_weight(TERRAIN_SOURCE source, ivec2 units) {
  float weight = 0.0;
  if (source.kind != 0u) {
    vec2 map_m = vec2(units) * (1.0 / kTerrainUnitsPerM);
    vec2 half_m = vec2(source.raster_size) * (0.5 * source.raster_spacing_m);
    // 0 on the border, 1 where the transition ends.
    vec2 depth = (half_m - abs(map_m)) / (half_m * (2.0 * kRasterBorder));
    weight = smoothstep(0.0, 1.0, min(depth.x, depth.y));
  }
  return weight;
}

// Returns the elevation in m, exaggeration included, at a point (1/64 m). Detail below about two spacings is left out.
float terrain_source_height(TERRAIN_SOURCE source, ivec2 units, float spacing_m) {
  float height_m = 0.0;
  if (source.kind == 0u) {
    height_m = terrain_height_at(units, spacing_m, source.seed);
  } else {
    vec2 map_m = vec2(units) * (1.0 / kTerrainUnitsPerM);
    vec2 half_m = vec2(source.raster_size) * (0.5 * source.raster_spacing_m);
    float inside = terrain_file_weight(source, units);
    if (inside < 1.0) {
      vec2 away = map_m / (4.0 * (half_m.x + half_m.y));
      height_m = (1.0 - inside) *
                 (terrain_height_at(units, spacing_m, source.seed) + source.outside_offset_m / (1.0 + dot(away, away)));
    }
    if (inside > 0.0) height_m += inside * terrain_raster_height(source, units, map_m, spacing_m);
  }
  return height_m * source.exaggeration;
}

// Returns the elevation at a point of one of the planet's map projections (src/scene/description/map_projection.hpp):
// the source belongs to map projection 0, the other map projections have procedural mountains.
float terrain_projection_height(TERRAIN_SOURCE source, uint projection, ivec2 units, float spacing_m) {
  float height_m = 0.0;
  if (projection == 0u) {
    height_m = terrain_source_height(source, units, spacing_m);
  } else {
    height_m =
        terrain_height_at(units, spacing_m, terrain_projection_seed(source.seed, projection)) * source.exaggeration;
  }
  return height_m;
}

#endif
