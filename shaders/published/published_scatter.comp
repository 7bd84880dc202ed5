// Computes the light of one order that a point scatters towards the eye, from the previous order in 128 directions. One
// invocation per texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "published/published_table.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer direction_block { vec4 directions[]; };
layout(binding = 2) uniform sampler3D order_before;
layout(binding = 3, rgba32f) uniform writeonly image3D scattered;
layout(push_constant) uniform Push { uint first; }
push;

void main() {
  uvec3 texel = gl_GlobalInvocationID + uvec3(0u, 0u, push.first);
  bool above;
  vec3 view;
  vec3 to_sun;
  Point here = table_point(medium, texel, above, view, to_sun);
  vec2 amount = density_at(medium, here.altitude);
  float horizon = horizon_cos(here.altitude, medium.planet_radius_m);
  vec3 sum = vec3(0.0);
  uint count = uint(directions.length());
  for (uint i = 0u; i < count; ++i) {
    vec3 from = directions[i].xyz;
    Point sample_point = Point(here.altitude, from.y, here.sun, dot(from, to_sun));
    vec3 light = table_value(order_before, table_coordinates(medium, sample_point, from.y > horizon));
    float nu = dot(from, view);
    sum += light * (amount.x * medium.rayleigh_scattering * rayleigh_phase(nu) +
                    amount.y * medium.mie_scattering * mie_phase(medium, nu));
  }
  imageStore(scattered, ivec3(texel), vec4(sum * (4.0 * kPi / float(count)), 0.0));
}
