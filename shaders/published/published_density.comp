// Density integrals of air molecules and aerosol to the top of the atmosphere [m]; 1e20 where the planet is in the way.
// Uses 200 steps of the trapezoidal rule. The table is linear in altitude and cosine. One invocation per texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "published/published_table.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(binding = 1, rg32f) uniform writeonly image2D density;

void main() {
  vec2 uv = (vec2(gl_GlobalInvocationID.xy) + 0.5) / vec2(imageSize(density));
  float top = medium.atmosphere_height_m;
  Point start = Point(clamp(uv.x * top, 10.0, top - 10.0), 2.0 * uv.y - 1.0, 0.0, 0.0);
  vec2 integral = vec2(1e20);
  if (!ray_hits_ground(start.altitude, start.view, medium.planet_radius_m)) {
    float step_m = ray_length(medium, start, true) / 200.0;
    vec2 before = density_at(medium, start.altitude);
    integral = vec2(0.0);
    for (int i = 1; i <= 200; ++i) {
      vec2 now = density_at(medium, point_along(medium, start, float(i) * step_m).altitude);
      integral += 0.5 * step_m * (before + now);
      before = now;
    }
  }
  imageStore(density, ivec2(gl_GlobalInvocationID.xy), vec4(integral, 0.0, 0.0));
}
