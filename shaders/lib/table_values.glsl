// Encoding of the scattering tables' texels. A texel holds the mean in-scattered light along a ray, where each stretch
// of the ray is weighted by the light that it could send to the eye. It is stored as the fourth root of
//   single, per species:  integral of (density x transmittance x sun's transmittance) / normalisation factor
//   higher orders:        radiance of orders >= 2 / (normalisation factor x angle_shape())
// The normalisation factor is the result for a medium of constant composition along the ray under a sun of 1. It has a
// closed form and follows every abrupt change at the horizon and near the boundaries, which leaves slowly varying
// values in [0; ~1]. These fall exponentially into twilight: interpolating the fourth root linearly has a quarter of
// the error, and half precision then covers fifteen decades.
#ifndef TYNDALL_LIB_TABLE_VALUES
#define TYNDALL_LIB_TABLE_VALUES

#include "lib/optical_depth.glsl"
#include "lib/phase.glsl"

struct NormalisationFactors {
  Spectrum rayleigh;  // [m]
  Spectrum mie;       // [m]
  Spectrum high;      // [sr], times radiance / E0
};

// Returns (1 - exp(-tau)) / tau: the mean transmittance within a slab of optical depth tau.
float mean_transmittance(float tau) {
  return tau < 1.0e-2 ? 1.0 - tau * (0.5 - tau * 0.166666666666667) : (1.0 - exp(-tau)) / tau;
}

// Returns the normalisation factors for the density integral of a whole ray.
NormalisationFactors normalisation_factors(IN(Medium) m, vec3 integral) {
  Spectrum tau = optical_depth(m, integral);
  Spectrum mean = EACH_CHANNEL(mean_transmittance, tau);
  NormalisationFactors g;
  g.rayleigh = max(integral.x, 1.0e-30) * mean;
  g.mie = max(integral.y, 1.0e-30) * mean;
  g.high = RAYLEIGH_SCATTERING(m) * g.rayleigh + MIE_SCATTERING(m) * g.mie;
  return g;
}

// The assumed dependence of the higher orders on the angle between view and sun: a constant, a weak trace of the
// Rayleigh phase function, and the aureole of light that aerosol scattered twice, in proportion to its part of the
// vertical optical depth. The table holds the ratio to it, which changes less between its few angles. The constants are
// fitted to tables with four times as many angles, at aerosol optical depths of 0.03 and 0.5.
const float kShapeRayleigh = 0.3;
const float kShapeAureole = 0.5;
const float kShapeAsymmetry = 0.7;  // of the aureole, over the asymmetry of the aerosol's phase function
// The parts of the shape that only depend on the medium. Compute them once, before a loop.
struct AngleShape {
  Spectrum aureole;
  float g;
};
AngleShape angle_shape_of(IN(Medium) m) {
  Spectrum aerosol = m.mie_scale_height_m * MIE_SCATTERING(m);
  Spectrum all = aerosol + m.rayleigh_scale_height_m * RAYLEIGH_SCATTERING(m);
  AngleShape s;
  s.aureole = kShapeAureole * 12.5663706143592 * aerosol / max(all, Spectrum(1.0e-30));
  s.g = kShapeAsymmetry * m.mie_g;
  return s;
}
Spectrum angle_shape(IN(AngleShape) s, float nu) {
  return Spectrum(1.0 + kShapeRayleigh * nu * nu) + henyey_greenstein_phase(nu, s.g) * s.aureole;
}

// Returns the density-weighted mean distance of a ray's medium from its origin [m]; Rayleigh density is the weight. The
// tables are indexed by the sun's zenith angle at this point. Along a grazing ray the sun's zenith angle changes by
// degrees. If the tables used the sun at the origin, the light from the far end would depend on the angle between view
// and sun, which has few texels, and could come from a sun that is outside the table.
// The integral of density times the distance q from the perigee has a closed form because q dq = r dr.
float density_weighted_mean_distance(IN(Medium) m, float h, float mu, float end_m, vec3 integral) {
  float R = m.planet_radius_m;
  float H = m.rayleigh_scale_height_m;
  float end = min(altitude_along(h, mu, end_m, R), m.atmosphere_height_m);
  float moment = H * ((R + h + H) * exp(min(-h / H, 60.0)) - (R + end + H) * exp(min(-end / H, 60.0)));
  return clamp(moment / max(integral.x, 1.0e-30) - (R + h) * mu, 0.0, end_m);
}

Spectrum texel_from_value(Spectrum value) { return sqrt(sqrt(max(value, Spectrum(0.0)))); }
Spectrum value_from_texel(Spectrum texel) {
  Spectrum squared = texel * texel;
  return squared * squared;
}

// Returns the density integral from altitude h towards the sun, where q = r cos(sun zenith) [m]. `hidden` is set if the
// planet blocks the sun. For the exponential species, the 1e-4 of the medium above the top is included.
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

// Returns the transmittance towards the sun; 0 if the planet hides it.
Spectrum sun_transmittance_at(IN(Medium) m, float h, float q) {
  bool hidden;
  vec3 integral = density_integral_to_sun(m, h, q, hidden);
  return hidden ? Spectrum(0.0) : transmittance(m, integral);
}

#endif
