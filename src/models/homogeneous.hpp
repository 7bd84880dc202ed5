// Hoffman and Preetham's model (2002) in double precision over shaders/lib/homogeneous.glsl: the model
// `homogeneous` of `probe` and `validate`, and what the scene uploads for it. Pure functions, safe from any thread.
#pragma once

#include <array>

#include "effect/shared.hpp"
#include "models/single_scattering.hpp"
#include "tyndall/params.hpp"

namespace tyndall::models {

// What the model needs beyond tyndall::Params: the optical lengths of air and haze from the ground to the zenith
// [m, haze at most air], and whether the densities fall off with altitude instead of holding everywhere.
struct HomogeneousLengths {
  double air_m = 8400.0;
  double haze_m = 1250.0;
  bool falloff = false;
};

// The constant medium: Rayleigh scattering of sea-level air, and the aerosol there as haze with `mie_g` in the
// Henyey-Greenstein function, whatever mie_phase says. Ozone and the scale heights do not enter. The sun is a point.
[[nodiscard]] shared::Homogeneous homogeneous_from_params(const Params& params, const HomogeneousLengths& lengths);

// Radiance / E0 and transmittance along a ray to the ground or out of the atmosphere, over black ground.
[[nodiscard]] Answer homogeneous_light(const shared::Homogeneous& medium, const Ray& ray);

// Horizontal irradiance / E0 of the sky on the ground.
[[nodiscard]] std::array<double, 3> homogeneous_sky_irradiance(const shared::Homogeneous& medium,
                                                               double cos_sun_zenith);

// Of the sun's light to the ground: 0 with the sun below the horizontal.
[[nodiscard]] std::array<double, 3> homogeneous_sun(const shared::Homogeneous& medium, double cos_sun_zenith);

}  // namespace tyndall::models
