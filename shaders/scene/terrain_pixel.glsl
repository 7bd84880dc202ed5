// The visible ground of a pixel, for the passes that light it. The scene's colour image holds packed ground points,
// which these passes replace by radiance.
#ifndef TYNDALL_TERRAIN_PIXEL_GLSL
#define TYNDALL_TERRAIN_PIXEL_GLSL

#include "scene/terrain_ground.glsl"
#include "scene/terrain_point.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 8, rgba32f) uniform image2D scene_color;

// Returns false outside the picture and where no ground is visible.
bool ground_of_pixel(ivec2 pixel, out GroundPoint point) {
  ivec2 size = imageSize(scene_color);
  if (pixel.x >= size.x || pixel.y >= size.y) return false;
  vec4 stored = imageLoad(scene_color, pixel);
  if (!is_ground_point(stored)) return false;
  unpack_level(stored, point.layer, point.morph);
  TerrainLevel level = terrain.levels[point.layer];
  TerrainLevel parent = terrain.levels[min(point.layer + 1u, terrain.layers - 1u)];
  vec2 cells = stored.xy - 0.5;  // from the level's first sample, whose index is even
  point.texel = stored.xy;
  point.parent_texel = cells * 0.5 + vec2(level.origin / 2 - parent.origin) + 0.5;
  point.offset_m = cells * level.cell_m + level.first_m;
  int cell_units = int(level.cell_m * kTerrainUnitsPerM + 0.5);
  point.units = level.origin * cell_units + ivec2(floor(cells * float(cell_units) + 0.5));
  point.altitude_m = stored.z;
  point.direction = local_direction(point.offset_m);
  point.position = local_position(point.direction, point.altitude_m);
  return true;
}

#endif
