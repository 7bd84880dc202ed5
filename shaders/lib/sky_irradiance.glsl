// Horizontal irradiance / E0 of the sky's single scattering.
#ifndef TYNDALL_LIB_SKY_IRRADIANCE
#define TYNDALL_LIB_SKY_IRRADIANCE

#include "lib/single_scattering.glsl"

// Returns the irradiance at altitude h for sun cosine mu_s, by a fixed product quadrature over the upper hemisphere.
// The zenith angle is split at the sun. Zenith angle and azimuth are substituted such that the distance from the sun is
// the square of the variable, which concentrates the nodes in the aureole.
// `panels` is the number of four-point panels on each side of the sun in zenith angle, and in azimuth over a half
// circle (the other half is its mirror image). `steps` is as in single_scattering().
Spectrum sky_irradiance_single(IN(Medium) m, float h, float mu_s, int panels, int steps) {
  float pi = 3.14159265358979;
  vec4 node = vec4(0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026);
  vec4 weight = vec4(0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727);
  float sun_zenith = acos(clamp(mu_s, 0.0, 1.0));  // a sun below the horizon counts as on the horizon
  float sin_sun = sqrt(max((1.0 - mu_s) * (1.0 + mu_s), 0.0));
  int nodes = 4 * panels;
  Spectrum irradiance = Spectrum(0.0);
  for (int side = 0; side < 2; ++side) {
    float reach = side == 0 ? sun_zenith : 0.5 * pi - sun_zenith;
    if (reach > 1.0e-6) {
      for (int i = 0; i < nodes; ++i) {
        float u = (float(i / 4) + node[i % 4]) / float(panels);
        // Between the sun and the horizon, concentrate nodes at both ends: the sky is bright near the horizon too.
        float offset = side == 0 ? reach * u * u : reach * u * u * (3.0 - 2.0 * u);
        float stretch = side == 0 ? 2.0 * reach * u : 6.0 * reach * u * (1.0 - u);
        float zenith = side == 0 ? sun_zenith - offset : sun_zenith + offset;
        float mu = cos(zenith);
        float sin_zenith = sin(zenith);
        float zenith_weight = stretch * weight[i % 4] / float(panels) * sin_zenith * mu;
        for (int j = 0; j < nodes; ++j) {
          float v = (float(j / 4) + node[j % 4]) / float(panels);
          float nu = clamp(mu * mu_s + sin_zenith * sin_sun * cos(pi * v * v), -1.0, 1.0);
          float azimuth_weight = 2.0 * 2.0 * pi * v * weight[j % 4] / float(panels);
          Spectrum unused;
          irradiance += zenith_weight * azimuth_weight * single_scattering_to_end(m, h, mu, mu_s, nu, steps, unused);
        }
      }
    }
  }
  return irradiance;
}

#endif
