// Integrates one order of scattering along the ray with 64 steps of the trapezoidal rule, and adds it to the previous
// orders. One invocation per texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "published/published_table.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(binding = 1) uniform sampler3D scattered;
layout(binding = 2, rgba32f) uniform writeonly image3D order_now;
layout(binding = 3, rgba16f) uniform image3D sum_of_orders;
layout(push_constant) uniform Push {
  uint first;
  uint adds;
}
push;  // adds: 0 for the first of the orders

void main() {
  uvec3 texel = gl_GlobalInvocationID + uvec3(0u, 0u, push.first);
  bool above;
  vec3 view;
  vec3 to_sun;
  Point start = table_point(medium, texel, above, view, to_sun);
  float step_m = ray_length(medium, start, above) / 64.0;
  vec2 integral = vec2(0.0);
  vec2 density_before = density_at(medium, start.altitude);
  vec3 before;
  vec3 radiance = vec3(0.0);
  for (int i = 0; i <= 64; ++i) {
    Point here = point_along(medium, start, float(i) * step_m);
    vec2 now = density_at(medium, here.altitude);
    if (i > 0) integral += 0.5 * step_m * (density_before + now);
    density_before = now;
    vec3 light = transmittance(medium, integral) * table_value(scattered, table_coordinates(medium, here, above));
    if (i > 0) radiance += 0.5 * step_m * (before + light);
    before = light;
  }
  imageStore(order_now, ivec3(texel), vec4(radiance, 0.0));
  vec3 sum = push.adds == 0u ? vec3(0.0) : imageLoad(sum_of_orders, ivec3(texel)).rgb;
  imageStore(sum_of_orders, ivec3(texel), vec4(sum + radiance, 0.0));
}
