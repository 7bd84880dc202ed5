// Radiance along given rays from the scattering tables as the renderer reads them, and the sky's irradiance: `tyndall
// probe --model precomputed`. One invocation per ray. rays: see prepare_probe_ray (src/models/single_scattering.hpp); a
// negative length requests the irradiance on a horizontal surface. results: radiance / E0 [1/sr] (sky: E / E0), and the
// transmittance to the ray's end.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "frame/phase_block.glsl"

#include "lib/single_scattering.glsl"
#include "frame/ground_light.glsl"
#include "frame/table_lookup.glsl"
#include "probe/result.glsl"
#include "shared/probe.h"
#include "shared/tables.h"

layout(local_size_x = 64) in;

layout(std430, binding = 1) readonly buffer ray_block { ProbeRay rays[]; };
layout(std430, binding = 2) writeonly buffer result_block { ProbeResult results[]; };
layout(std430, binding = 3) readonly buffer setup_block {
  TableShape shape;
  uint integrate_single;  // 1: order 1 by integration, the tables for the rest
  uint steps;             // of that integration, see single_scattering()
  uint visible_ground;    // 1: includes the light that the ground reflects at the ray's end
};
layout(binding = 4) uniform sampler2D sky_irradiance;

// Returns the radiance reflected by the ground at the ray's end.
Spectrum ground_light(ProbeRay ray) {
  return ground_light(medium, sky_irradiance, ray.altitude_m, ray.cos_sun_zenith, ray.cos_view_sun, ray.end_m);
}

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= uint(rays.length())) return;
  ProbeRay ray = rays[index];
  if (ray.end_m < 0.0) {
    Spectrum towards_sun = sun_visibility(ray.altitude_m, ray.cos_sun_zenith, medium.planet_radius_m) *
                           transmittance(medium, density_integral_to_top(medium, ray.altitude_m, ray.cos_sun_zenith));
    results[index] = PROBE_RESULT(sky_light(medium, sky_irradiance, ray.altitude_m, ray.cos_sun_zenith), towards_sun);
    return;
  }
  if (ray.end_m == 0.0) {
    Spectrum seen = ray.on_ground == 1u && visible_ground == 1u ? ground_light(ray) : Spectrum(0.0);
    results[index] = PROBE_RESULT(seen, Spectrum(1.0));
    return;
  }
  TableRay path = TableRay(ray.altitude_m, ray.cos_view_zenith, ray.cos_sun_zenith, ray.cos_view_sun,
                           ray.on_ground == 1u, ray.end_m);
  InScattering light = inscattering_to_end(shape, medium, table_angle(shape, medium, path.cos_view_sun), path);
  light.high *= deep_factor(medium, path);
  if (integrate_single == 1u || ray.integrate_single == 1u) {
    light.single = single_scattering(medium, ray.altitude_m, ray.cos_view_zenith, ray.cos_sun_zenith, ray.cos_view_sun,
                                     0.0, ray.end_m, int(steps));
  }
  Spectrum path_transmittance =
      transmittance(medium, density_integral_along(medium, ray.altitude_m, ray.cos_view_zenith, ray.end_m));
  Spectrum radiance = light.single + light.high;
  if (ray.on_ground == 1u && visible_ground == 1u) radiance += path_transmittance * ground_light(ray);
  results[index] = PROBE_RESULT(radiance, path_transmittance);
}
