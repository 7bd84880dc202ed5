// The light of the sun and of the sky that the ground reflects.
#ifndef TYNDALL_GROUND_LIGHT_GLSL
#define TYNDALL_GROUND_LIGHT_GLSL

#include "lib/spectrum.glsl"
#include "lib/table_values.glsl"
#include "tyndall/light_tables.glsl"

// Returns the irradiance of the sky on a horizontal surface at the altitude h, from LightTables::sky_irradiance.
Spectrum sky_light(Medium m, sampler2D sky_irradiance, float h, float mu_s) {
  return LIGHT_OF_TEXEL(
      textureLod(sky_irradiance, light_table_uv(h, mu_s, m.planet_radius_m, m.atmosphere_height_m), 0.0));
}

// Returns the radiance of the ground at the end of a ray, relative to the sun's irradiance above the atmosphere [1/sr].
Spectrum ground_light(Medium m, sampler2D sky_irradiance, float h, float mu_s, float nu, float end_m) {
  float R = m.planet_radius_m;
  float q = (R + h) * mu_s + end_m * nu;
  float ground = ground_below(h, R);
  float cos_sun = q / (R + ground);
  Spectrum light =
      max(cos_sun, 0.0) * sun_transmittance_at(m, ground, q) + sky_light(m, sky_irradiance, ground, cos_sun);
  return light * (GROUND_ALBEDO(m) * 0.318309886183791);
}

#endif
