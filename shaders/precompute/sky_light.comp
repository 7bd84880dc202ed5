// Irradiance of the sky on a horizontal surface, per irradiance of the sun above the atmosphere: light
// scattered once by a quadrature of its own, and the higher orders as the gathering grid has them (sky).
// Out: rgb (LightTables::sky_irradiance). One invocation per texel; `first` is the first column to fill.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "lib/sky_irradiance.glsl"
#include "lib/table_values.glsl"
#include "precompute/gather_grid.glsl"
#include "tyndall/light_tables.glsl"

layout(local_size_x = 1, local_size_y = 8) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(binding = 1, rgba16f) uniform writeonly image2D sky_irradiance_table;

layout(std430, binding = 2) readonly buffer sky_block { vec4 sky[]; };  // altitude x sun

layout(push_constant) uniform Push { int first; } push;

// Fourth roots are interpolated: twilight falls like an exponential.
vec3 higher_orders(float h, float mu_s) {
  float altitude = gather_altitude_index(medium, h);
  float sun = gather_sun_index(medium, mu_s);
  uint a = min(uint(altitude), kGatherAltitudes - 2u);
  uint s = min(uint(sun), kGatherSuns - 2u);
  uint i = a * kGatherSuns + s;
  vec3 low = mix(texel_from_value(sky[i].rgb), texel_from_value(sky[i + 1u].rgb), sun - float(s));
  i += kGatherSuns;
  vec3 high = mix(texel_from_value(sky[i].rgb), texel_from_value(sky[i + 1u].rgb), sun - float(s));
  return value_from_texel(mix(low, high, altitude - float(a)));
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy) + ivec2(push.first, 0);
  ivec2 size = imageSize(sky_irradiance_table);
  if (texel.x >= size.x || texel.y >= size.y) return;
  vec2 uv = (vec2(texel) + 0.5) / vec2(size);
  vec2 point = light_table_point(uv, medium.planet_radius_m, medium.atmosphere_height_m);
  vec3 irradiance = sky_irradiance_single(medium, point.x, point.y, 2, 4) + higher_orders(point.x, point.y);
  imageStore(sky_irradiance_table, texel, vec4(irradiance, 1.0));
}
