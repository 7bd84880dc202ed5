// Hoffman and Preetham's model (2002) in double precision, from shaders/lib/homogeneous.glsl: the model `homogeneous`
// of `probe` and `validate`, and the constants that the scene uploads. Pure functions, safe from any thread.
#pragma once

#include <array>

#include "effect/shared.hpp"
#include "models/single_scattering.hpp"
#include "tyndall/params.hpp"

namespace tyndall::models {

// The inputs of the model besides tyndall::Params: the vertical optical lengths of air and haze from the ground [m],
// with haze_m <= air_m, and whether the densities fall with altitude instead of being constant.
struct HomogeneousLengths {
  double air_m = 8400.0;
  double haze_m = 1250.0;
  bool falloff = false;
};

// Returns the medium: air and aerosol (haze) with their sea-level coefficients. Haze always has the Henyey-Greenstein
// function with `mie_g`, whatever mie_phase is. Ozone and scale heights are ignored. The sun is a point.
[[nodiscard]] shared::Homogeneous homogeneous_from_params(const Params& params, const HomogeneousLengths& lengths);

// Returns radiance / E0 and transmittance along a ray to the ground or out of the atmosphere, over black ground.
[[nodiscard]] Answer homogeneous_light(const shared::Homogeneous& medium, const Ray& ray);

// Returns the horizontal irradiance / E0 of the sky at an altitude. Without falloff, it is that at the ground
// everywhere inside the atmosphere. It is 0 in space, and if the sun is below the horizontal.
[[nodiscard]] std::array<double, 3> homogeneous_sky_irradiance(const shared::Homogeneous& medium, double altitude_m,
                                                               double cos_sun_zenith);

// Returns the transmittance of sunlight to an altitude: 0 if the sun is below the horizontal, or, in space, behind the
// planet. Without falloff, it is that at the ground everywhere inside the atmosphere.
[[nodiscard]] std::array<double, 3> homogeneous_sun(const shared::Homogeneous& medium, double altitude_m,
                                                    double cos_sun_zenith);

}  // namespace tyndall::models
