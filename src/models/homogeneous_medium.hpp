// The homogeneous medium of Yusov (2012) where nothing is in shadow, in double precision: the model
// `homogeneous-medium` of `probe` and `validate`, and what the renderer's scattering.medium = homogeneous is tested
// against. docs/homogeneous_medium.md has the equations. Pure functions, safe from any thread.
#pragma once

#include <array>

#include "models/single_scattering.hpp"
#include "tyndall/params.hpp"

namespace tyndall::models {

// Coefficients at sea level times homogeneous_medium.density [1/m].
struct HomogeneousMedium {
  std::array<double, 3> rayleigh_scattering = {};
  std::array<double, 3> mie_scattering = {};
  std::array<double, 3> extinction = {};
  std::array<double, 3> sunlight = {};  // that arrives, relative to the sun's irradiance above the atmosphere
  double g = 0.0;
  bool cornette_shanks = true;  // or Henyey-Greenstein
  double planet_radius_m = 0.0;
  double extent_m = 0.0;  // of rays that do not meet the planet
  double height_m = 0.0;  // of the flat top
};

[[nodiscard]] HomogeneousMedium homogeneous_medium_from_params(const Params& params);

// Radiance / E0 and transmittance along a ray to the planet, to the medium's top or to its extent, over black ground.
// The sun lights the medium from wherever it stands, from below the horizon too.
[[nodiscard]] Answer homogeneous_medium_light(const HomogeneousMedium& medium, const Ray& ray);

// Horizontal irradiance / E0 of what comes from above.
[[nodiscard]] std::array<double, 3> homogeneous_medium_sky(const HomogeneousMedium& medium, double altitude_m,
                                                           double cos_sun_zenith);

}  // namespace tyndall::models
