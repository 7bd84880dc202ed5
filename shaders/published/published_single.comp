// Integrates single scattering along the ray with 100 steps of the trapezoidal rule. One invocation per texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "published/published_table.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(binding = 1) uniform sampler2D density;
layout(binding = 2, rgba16f) uniform writeonly image3D single;
layout(push_constant) uniform Push { uint first; }
push;

void main() {
  uvec3 texel = gl_GlobalInvocationID + uvec3(0u, 0u, push.first);
  bool above;
  vec3 view;
  vec3 to_sun;
  Point start = table_point(medium, texel, above, view, to_sun);
  float step_m = ray_length(medium, start, above) / 100.0;
  vec2 integral = vec2(0.0);
  vec2 density_before = density_at(medium, start.altitude);
  vec3 rayleigh_before;
  vec3 mie_before;
  vec3 rayleigh = vec3(0.0);
  vec3 mie = vec3(0.0);
  for (int i = 0; i <= 100; ++i) {
    Point here = point_along(medium, start, float(i) * step_m);
    vec2 now = density_at(medium, here.altitude);
    if (i > 0) integral += 0.5 * step_m * (density_before + now);
    density_before = now;
    vec2 uv = vec2(here.altitude / medium.atmosphere_height_m, 0.5 * here.sun + 0.5);
    vec3 light = transmittance(medium, integral + textureLod(density, uv, 0.0).rg);
    if (i > 0) {
      rayleigh += 0.5 * step_m * (rayleigh_before + light * now.x);
      mie += 0.5 * step_m * (mie_before + light * now.y);
    }
    rayleigh_before = light * now.x;
    mie_before = light * now.y;
  }
  vec3 radiance = rayleigh * medium.rayleigh_scattering * rayleigh_phase(start.between) +
                  mie * medium.mie_scattering * mie_phase(medium, start.between);
  imageStore(single, ivec3(texel), vec4(radiance, 0.0));
}
