// Interpolates the irradiance of the sky on a horizontal surface, per irradiance of the sun above the atmosphere, from
// the points of the gathering grid (altitude x sun). It contains all orders. Writes LightTables::sky_irradiance. One
// invocation per texel.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/table_values.glsl"
#include "precompute/gather_grid.glsl"
#include "precompute/half_texel.glsl"
#include "tyndall/light_tables.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(binding = 1, rgba16f) uniform writeonly image2D sky_irradiance_table;
layout(std430, binding = 2) readonly buffer sky_block { vec4 sky[]; };

Spectrum between_suns(uint first, float part) {
  return mix(texel_from_value(CHANNELS(sky[first])), texel_from_value(CHANNELS(sky[first + 1u])), part);
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(sky_irradiance_table);
  if (texel.x >= size.x || texel.y >= size.y) return;
  vec2 uv = (vec2(texel) + 0.5) / vec2(size);
  vec2 point = light_table_point(uv, medium.planet_radius_m, medium.atmosphere_height_m);
  float altitude = gather_altitude_index(medium, point.x);
  float sun = gather_sun_index(sun_axis(medium), point.y);
  uint a = min(uint(altitude), kGatherAltitudes - 2u);
  uint s = min(uint(sun), kGatherSuns - 2u);
  // Fourth roots are interpolated because twilight decreases exponentially.
  Spectrum low = between_suns(a * kGatherSuns + s, sun - float(s));
  Spectrum high = between_suns((a + 1u) * kGatherSuns + s, sun - float(s));
  imageStore(sky_irradiance_table, texel,
             half_texel(LIGHT_TEXEL(value_from_texel(mix(low, high, altitude - float(a))))));
}
