// The homogeneous medium of Yusov (2012) without shadows, in double precision: the model `homogeneous-medium` of
// `probe` and `validate`, and the reference for tests of scattering.medium = homogeneous. docs/homogeneous_medium.md
// has the equations. Pure functions, safe from any thread.
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
  std::array<double, 3> sunlight =
      {};  // sunlight at every point of the medium, relative to the sun's irradiance above the atmosphere
  double g = 0.0;
  bool cornette_shanks = true;  // false: Henyey-Greenstein
  // The parameters, if their phase function has no formula, and the wavelengths of the channels [nm].
  const Params* tabulated = nullptr;
  std::array<double, 3> wavelengths_nm = {};
  double planet_radius_m = 0.0;
  double extent_m = 0.0;  // length of rays that do not hit the planet
  double height_m = 0.0;  // altitude of the flat top
};

// `sea_level`: the medium at sea level, medium_from_params() or, for the fourth wavelength, models::medium_at_fourth().
// `params` must outlive the result.
[[nodiscard]] HomogeneousMedium homogeneous_medium_from_params(const Params& params, const shared::Medium& sea_level,
                                                               bool fourth = false);
[[nodiscard]] HomogeneousMedium homogeneous_medium_from_params(const Params& params);

// Returns radiance / E0 and transmittance along a ray to the planet, to the medium's top or to its extent, over black
// ground. The sun lights the medium from any direction, even from below the horizon.
[[nodiscard]] Answer homogeneous_medium_light(const HomogeneousMedium& medium, const Ray& ray);

// Returns the horizontal irradiance / E0 of the light from above.
[[nodiscard]] std::array<double, 3> homogeneous_medium_sky(const HomogeneousMedium& medium, double altitude_m,
                                                           double cos_sun_zenith);

}  // namespace tyndall::models
