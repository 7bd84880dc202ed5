// Irradiance of the single-scattered sky on a horizontal surface, per irradiance of the sun above the
// atmosphere: an estimate from below of the true skylight, which also holds light scattered more than once.
// Out: rgb (LightTables::sky_irradiance). One invocation per texel; `first` is the first column to fill.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "lib/sky_irradiance.glsl"
#include "tyndall/light_tables.glsl"

layout(local_size_x = 1, local_size_y = 8) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(binding = 1, rgba16f) uniform writeonly image2D sky_irradiance_table;

layout(push_constant) uniform Push { int first; } push;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy) + ivec2(push.first, 0);
  ivec2 size = imageSize(sky_irradiance_table);
  if (texel.x >= size.x || texel.y >= size.y) return;
  vec2 uv = (vec2(texel) + 0.5) / vec2(size);
  vec2 point = light_table_point(uv, medium.planet_radius_m, medium.atmosphere_height_m);
  imageStore(sky_irradiance_table, texel, vec4(sky_irradiance_single(medium, point.x, point.y, 2, 4), 1.0));
}
