// The ground in sunlight that has come through the air and under the light of the sky, once for each pixel that shows it.
// In: what terrain.frag has left. Out, in its place: radiance of the ground itself; what the air adds between it and the
// eye is the effect's business.
#version 460
#extension GL_GOOGLE_include_directive : require

#define SHADOW_COLORS 6
#include "scene/terrain_ground.glsl"
#include "scene/terrain_point.glsl"
#include "tyndall/light_tables.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = 4) uniform sampler2D sun_transmittance;
layout(binding = 5) uniform sampler2D sky_irradiance;
layout(binding = 7, rgba32f) uniform image2D scene_color;

void ground_light(float altitude_m, float cos_sun_zenith, out vec3 sun, out vec3 sky) {
  vec2 uv = light_table_uv(altitude_m, cos_sun_zenith, terrain.planet_radius_m, terrain.atmosphere_height_m);
  sun = textureLod(sun_transmittance, uv, 0.0).rgb;
  sky = textureLod(sky_irradiance, uv, 0.0).rgb;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(scene_color);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  vec4 stored = imageLoad(scene_color, pixel);
  if (!is_ground_point(stored)) return;
  GroundPoint point;
  unpack_level(stored, point.layer, point.morph);
  TerrainLevel level = terrain.levels[point.layer];
  TerrainLevel parent = terrain.levels[min(point.layer + 1u, terrain.layers - 1u)];
  vec2 cells = stored.xy - 0.5;  // from the level's first sample, whose index is even
  point.texel = stored.xy;
  point.parent_texel = cells * 0.5 + vec2(level.origin / 2 - parent.origin) + 0.5;
  point.map_m = (vec2(level.origin) + cells) * level.cell_m;
  point.altitude_m = stored.z;
  point.position = world_from_map(point.map_m, point.altitude_m, terrain.planet_radius_m);
  imageStore(scene_color, pixel, vec4(ground_radiance(point), 1.0));
}
