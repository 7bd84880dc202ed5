// Transmittance of the sunlight that reaches a point, softened at the horizon by the sun's disc.
// Out: rgb = fraction of the irradiance above the atmosphere (LightTables::sun_transmittance).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "lib/optical_depth.glsl"
#include "precompute/half_texel.glsl"
#include "tyndall/light_tables.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(binding = 1, rgba16f) uniform writeonly image2D sun_transmittance;

// Mean angular radius of the sun [rad]. Only the few texels at the horizon depend on it.
const float kSunAngularRadius = 0.004655;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(sun_transmittance);
  if (texel.x >= size.x || texel.y >= size.y) return;
  vec2 uv = (vec2(texel) + 0.5) / vec2(size);
  vec2 point = light_table_point(uv, medium.planet_radius_m, medium.atmosphere_height_m);
  float visible = sun_disc_visibility(point.x, point.y, medium.planet_radius_m, kSunAngularRadius);
  // Where only the upper limb is seen, its light has grazed the horizon.
  float cosine = max(point.y, horizon_cos(point.x, medium.planet_radius_m));
  Spectrum light = visible * transmittance(medium, density_integral_to_top(medium, point.x, cosine));
  imageStore(sun_transmittance, texel, half_texel(LIGHT_TEXEL(light)));
}
