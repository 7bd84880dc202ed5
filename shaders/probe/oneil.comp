#version 460
// O'Neil's model along given rays, with the code of the scene's shaders. One invocation per ray. rays: see
// prepare_probe_ray (src/models/single_scattering.hpp). results: radiance / E0 [1/sr] over black ground, and the
// transmittance to the ray's end.
#extension GL_GOOGLE_include_directive : require

layout(std430, binding = 4) readonly buffer oneil_table_block { vec4 oneil_texels[]; };
#define ONEIL_TEXEL(table, index) oneil_texels[index]
#include "lib/oneil.glsl"
#include "shared/probe.h"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer ray_block { ProbeRay rays[]; };
layout(std430, binding = 2) writeonly buffer result_block { ProbeResult results[]; };
layout(std430, binding = 3) readonly buffer oneil_block { Oneil oneil; };

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= uint(rays.length())) {
    return;
  }
  ProbeRay ray = rays[index];
  vec3 radiance = vec3(0.0);
  vec3 path_transmittance = vec3(1.0);
  if (ray.end_m > 0.0) {
    OneilRay path = OneilRay(ray.altitude_m, ray.cos_view_zenith, ray.cos_sun_zenith, ray.cos_view_sun);
    OneilLight light = oneil_scattering(medium, oneil, 0u, path, 0.0, ray.end_m);
    radiance = oneil_radiance(medium, oneil, ray.cos_view_sun, light.rayleigh, light.mie);
    path_transmittance = light.transmittance;
  }
  results[index] = ProbeResult(radiance, 0.0, path_transmittance, 0.0);
}
