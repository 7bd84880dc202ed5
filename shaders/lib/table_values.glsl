// What a texel of the scattering tables holds. In words: the mean of the light along the ray, over the share
// that each stretch of it sends to the eye. As numbers: the fourth root of
//   single, per species:  integral of (density x transmittance x sun's transmittance) / guide
//   higher orders:        radiance of orders >= 2 / guide
// where the guide is what a medium mixed evenly along the ray would give under a sun of 1. It is known in
// closed form, follows every abrupt change at the horizon and near the boundaries, and leaves numbers in
// [0; ~1] that vary slowly. What remains falls like an exponential into twilight; linear interpolation of its
// fourth root errs a quarter as much as of itself, and half precision covers fifteen decades.
#ifndef TYNDALL_LIB_TABLE_VALUES
#define TYNDALL_LIB_TABLE_VALUES

#include "lib/optical_depth.glsl"

struct NormalisationFactors {
  vec3 rayleigh;  // [m]
  vec3 mie;       // [m]
  vec3 high;      // sr times a radiance / E0
};

// (1 - exp(-tau)) / tau: the mean transmittance within a slab of optical depth tau.
float mean_transmittance(float tau) {
  return tau < 1.0e-2 ? 1.0 - tau * (0.5 - tau * 0.166666666666667) : (1.0 - exp(-tau)) / tau;
}

// For the column of a whole ray.
NormalisationFactors normalisation_factors(IN(Medium) m, vec3 column) {
  vec3 tau = optical_depth(m, column);
  vec3 mean = vec3(mean_transmittance(tau.x), mean_transmittance(tau.y), mean_transmittance(tau.z));
  NormalisationFactors g;
  g.rayleigh = max(column.x, 1.0e-30) * mean;
  g.mie = max(column.y, 1.0e-30) * mean;
  g.high = m.rayleigh_scattering * g.rayleigh + m.mie_scattering * g.mie;
  return g;
}

// Distance from altitude h to the middle of a ray's air, weighed by the density of the first species [m]: the
// point whose sun the tables go by. Along a grazing ray the sun's height changes by degrees; told by the
// sun at its origin, the light of the far end would hang on the angle between view and sun, of which there are
// few texels, and under a sun that the table no longer holds. The integral of density times distance q from the
// perigee is closed: q dq = r dr.
float density_weighted_mean_distance(IN(Medium) m, float h, float mu, float end_m, vec3 column) {
  float R = m.planet_radius_m;
  float H = m.rayleigh_scale_height_m;
  float end = min(altitude_along(h, mu, end_m, R), m.atmosphere_height_m);
  float moment = H * ((R + h + H) * exp(min(-h / H, 60.0)) - (R + end + H) * exp(min(-end / H, 60.0)));
  return clamp(moment / max(column.x, 1.0e-30) - (R + h) * mu, 0.0, end_m);
}

vec3 texel_from_value(vec3 value) { return sqrt(sqrt(max(value, vec3(0.0)))); }
vec3 value_from_texel(vec3 texel) {
  vec3 squared = texel * texel;
  return squared * squared;
}

// Column towards the sun from altitude h where the ray to it has q = r cos(zenith) [m]; `hidden` if the
// planet is in the way. What lies above the top is left in for the exponential species: a 1e-4th of them.
vec3 density_integral_to_sun(IN(Medium) m, float h, float q, OUT(bool) hidden) {
  float R = m.planet_radius_m;
  float top = m.atmosphere_height_m;
  float out_q = abs(q);
  hidden = false;
  vec3 outward =
      vec3(exponential_density_integral(h, out_q, m.rayleigh_scale_height_m, R),
           exponential_density_integral(h, out_q, m.mie_scale_height_m, R), ozone_density_integral(m, h, out_q, top));
  if (q >= 0.0) {
    return outward;
  }
  float r = R + h;
  float perigee = h - q * q / (r + sqrt(max((r - out_q) * (r + out_q), 0.0)));
  hidden = perigee < 0.0;
  if (hidden) {
    return outward;
  }
  vec3 across = vec3(exponential_density_integral(perigee, 0.0, m.rayleigh_scale_height_m, R),
                     exponential_density_integral(perigee, 0.0, m.mie_scale_height_m, R),
                     ozone_density_integral(m, perigee, 0.0, top));
  return 2.0 * across - outward;
}

// Transmittance towards the sun, 0 where the planet hides it.
vec3 sun_transmittance_at(IN(Medium) m, float h, float q) {
  bool hidden;
  vec3 column = density_integral_to_sun(m, h, q, hidden);
  return hidden ? vec3(0.0) : transmittance(m, column);
}

#endif
