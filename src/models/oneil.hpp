// O'Neil's model (GPU Gems 2, chapter 16, 2005) in double precision, from shaders/lib/oneil.glsl: the models `oneil`
// and `oneil-table` of `probe`, and the constants of the shaders. It computes single scattering over black ground
// without ozone, relative to the sun's irradiance above the atmosphere. docs/oneil.md describes it.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "effect/shared.hpp"
#include "models/single_scattering.hpp"
#include "tyndall/params.hpp"

namespace tyndall::models {

enum class OneilIntegralMethod : std::uint32_t {
  computed = 0,   // scale function, fitted to the planet and to each species
  published = 1,  // polynomial and equations as published
  table = 2,      // the table of O'Neil 2004
};

struct OneilSettings {
  OneilIntegralMethod integral_method = OneilIntegralMethod::computed;
  std::uint32_t samples = 5;       // [1; 4096] sample points per ray
  std::uint32_t table_size = 128;  // [16; 1024] entries along each side
  bool space_by_density = false;   // place more sample points where the medium is dense; not with `published`
  bool rayleigh_phase = true;      // false: Rayleigh scattering is isotropic

  bool operator==(const OneilSettings&) const = default;
};

// Relative errors of the density integrals of one species along rays that leave the atmosphere upwards.
struct IntegralError {
  double worst = 0.0, rms = 0.0;
};

// The model's data for one planet, for shaders and functions. Immutable once made.
struct OneilModel {
  shared::Medium medium;
  shared::Oneil constants;
  std::vector<std::array<float, 4>> table;  // constants.table_size squared entries; one entry of zeros if not used
  // Errors over all cosines: at sea level, and over altitudes up to three scale heights.
  IntegralError rayleigh_at_sea_level, mie_at_sea_level, rayleigh, mie;
};

// Returns the medium that make_oneil() takes.
[[nodiscard]] shared::Medium oneil_medium(const Params& params);

// Fits the scale functions or fills the table, and measures their errors. Takes milliseconds.
[[nodiscard]] OneilModel make_oneil(const shared::Medium& medium, const OneilSettings& settings);

// Describes the errors in one line, for messages and reports.
[[nodiscard]] std::string describe_errors(const OneilModel& model);

[[nodiscard]] Answer oneil(const OneilModel& model, const Ray& ray);
// Returns the horizontal irradiance / E0 of the sky at an altitude, from 2 nodes^2 rays.
[[nodiscard]] std::array<double, 3> oneil_sky_irradiance(const OneilModel& model, double altitude_m,
                                                         double cos_sun_zenith, int nodes = 24);
// Returns the transmittance of sunlight to a point: 0 if the planet hides the sun.
[[nodiscard]] std::array<double, 3> oneil_sun_transmittance(const OneilModel& model, double altitude_m,
                                                            double cos_sun_zenith);

// Returns the density integral [m] of an exponential species along a ray from `altitude_m` outwards to the altitude
// `top_m`, which may be infinite. Computed numerically with a relative error of 1e-9. Precondition: cosine >= 0.
[[nodiscard]] double exponential_density_integral(double scale_height_m, double radius_m, double altitude_m,
                                                  double cosine, double top_m);

}  // namespace tyndall::models
