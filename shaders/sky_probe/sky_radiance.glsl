// The radiance of the sky around a sky probe, and of the ground below its horizon, from the scattering tables.
#ifndef TYNDALL_SKY_RADIANCE_GLSL
#define TYNDALL_SKY_RADIANCE_GLSL

#include "frame/phase_block.glsl"

#include "frame/ground_light.glsl"
#include "frame/table_lookup.glsl"
#include "lib/single_scattering.glsl"
#include "shared/sky_probe.h"
#include "shared/tables.h"

layout(std430, binding = 1) readonly buffer sky_probe_block { SkyProbeConstants probe; };
layout(binding = 4) uniform sampler2D sky_irradiance_table;

// Returns the radiance that arrives from a direction, relative to the sun's irradiance above the atmosphere [1/sr].
// mu, nu: cosines of its angles to the zenith and to the sun. below: whether it meets the ground. The sun's disc is
// left out.
vec3 sky_radiance(float mu, float nu, bool below) {
  float h = probe.altitude_m;
  TableRay ray = table_ray(medium, h, mu, probe.cos_sun_zenith, nu, below);
  vec3 integral = density_integral_along(medium, h, ray.cos_zenith, ray.end_m);
  InScattering light =
      inscattering_from_integral(probe.shape, medium, table_angle(probe.shape, medium, nu), ray, integral);
  if (probe.integrate_single == 1u) {
    light.single = single_scattering(medium, h, ray.cos_zenith, probe.cos_sun_zenith, nu, 0.0, ray.end_m, 16);
  }
  Spectrum sum = light.single + light.high * deep_factor(medium, ray);
  if (below) {
    sum += transmittance(medium, integral) *
           ground_light(medium, sky_irradiance_table, h, probe.cos_sun_zenith, nu, ray.end_m);
  }
  return COLOR(sum);
}

#endif
