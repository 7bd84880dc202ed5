// Looks up given rays in the published tables. One invocation per ray; rays and results are as in shaders/probe.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "published/published_table.glsl"
#include "shared/probe.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer ray_block { ProbeRay rays[]; };
layout(std430, binding = 2) writeonly buffer result_block { ProbeResult results[]; };
layout(binding = 3) uniform sampler3D single;
layout(binding = 4) uniform sampler3D sum_of_orders;

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= uint(rays.length())) return;
  ProbeRay ray = rays[index];
  vec3 radiance = vec3(0.0);
  if (ray.end_m > 0.0) {
    Point start = Point(ray.altitude_m, ray.cos_view_zenith, ray.cos_sun_zenith, ray.cos_view_sun);
    vec4 c = table_coordinates(medium, start, ray.on_ground == 0u);
    radiance = table_value(single, c) + table_value(sum_of_orders, c);
  }
  results[index] = ProbeResult(radiance, 0.0, vec3(0.0), 0.0);
}
