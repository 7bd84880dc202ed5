// Irradiance on level ground under a sky that is a function of the ray, in double precision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace tyndall::models {

// Integrates `radiance` times cosine over the upper hemisphere. Steps of the azimuth are equal, because the function is
// periodic. Zenith angles are at Gauss nodes of x, with zenith angle (1 - x^2) 90 degrees: dense near the horizon,
// where a sky changes fastest. `radiance` takes the cosines of the view zenith angle and of the angle between view and
// sun, and returns three channels. `zenith_panels` is the number of panels of two nodes each.
template <typename Radiance>
std::array<double, 3> hemisphere_irradiance(double cos_sun_zenith, int zenith_panels, int azimuths,
                                            const Radiance& radiance) {
  const double sin_sun = std::sqrt(std::max(1.0 - cos_sun_zenith * cos_sun_zenith, 0.0));
  std::array<double, 3> sum = {};
  for (int i = 0; i < 2 * zenith_panels; ++i) {
    const double node = (i % 2 == 0 ? -1.0 : 1.0) / std::numbers::sqrt3;
    const double x = (i / 2 + 0.5 + 0.5 * node) / zenith_panels;
    const double zenith = 0.5 * std::numbers::pi * (1.0 - x * x);
    const double weight = std::numbers::pi * x / (2.0 * zenith_panels);  // |d zenith / d x| times the node's weight
    const double mu = std::cos(zenith);
    const double sine = std::sin(zenith);
    for (int k = 0; k < azimuths; ++k) {
      const double azimuth = 2.0 * std::numbers::pi * (k + 0.5) / azimuths;
      const std::array<double, 3> light = radiance(mu, mu * cos_sun_zenith + sine * sin_sun * std::cos(azimuth));
      for (std::size_t c = 0; c < 3; ++c) sum[c] += light[c] * (weight * mu * sine * 2.0 * std::numbers::pi / azimuths);
    }
  }
  return sum;
}

}  // namespace tyndall::models
