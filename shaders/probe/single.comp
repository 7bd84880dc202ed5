#version 460
// Single scattering along given rays by numerical integration: `tyndall probe --model single`. One invocation per ray.
// rays: see prepare_probe_ray (src/models/single_scattering.hpp). results: radiance / E0 [1/sr] over black ground, and
// the transmittance to the ray's end.
#extension GL_GOOGLE_include_directive : require

#include "frame/phase_block.glsl"

#include "lib/single_scattering.glsl"
#include "probe/result.glsl"
#include "shared/probe.h"

layout(local_size_x = 64) in;

const int kSteps = 16;  // see single_scattering()

layout(std430, binding = 1) readonly buffer ray_block { ProbeRay rays[]; };
layout(std430, binding = 2) writeonly buffer result_block { ProbeResult results[]; };

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= uint(rays.length())) {
    return;
  }
  ProbeRay ray = rays[index];
  Spectrum radiance = single_scattering(medium, ray.altitude_m, ray.cos_view_zenith, ray.cos_sun_zenith,
                                        ray.cos_view_sun, 0.0, ray.end_m, kSteps);
  vec3 integral = density_integral_along(medium, ray.altitude_m, ray.cos_view_zenith, ray.end_m);
  results[index] = PROBE_RESULT(radiance, transmittance(medium, integral));
}
