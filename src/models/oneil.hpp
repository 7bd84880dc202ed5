// O'Neil's model (GPU Gems 2, chapter 16, 2005) in double precision over shaders/lib/oneil.glsl: the models
// `oneil` and `oneil-table` of `probe`, and what the shaders are given. Light scattered once over black
// ground, relative to the sun's irradiance above the atmosphere; no ozone. docs/oneil.md describes it.
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
  computed = 0,   // scale function fitted to the planet and to each species
  published = 1,  // the polynomial and the equations as printed
  table = 2,      // the table of 2004
};

struct OneilSettings {
  OneilIntegralMethod integral_method = OneilIntegralMethod::computed;
  std::uint32_t samples = 5;       // [1; 4096] points on a ray
  std::uint32_t table_size = 128;  // [16; 1024] entries along each side
  bool space_by_column = false;    // points where most of the air is; not with the printed equations
  bool rayleigh_phase = true;      // false: Rayleigh scattering is even in all directions

  bool operator==(const OneilSettings&) const = default;
};

// How far columns are from those of the integral, relative to these: of outward rays, per species.
struct ColumnError {
  double worst = 0.0, rms = 0.0;
};

// What shaders and functions read of one planet. Immutable once made.
struct OneilModel {
  shared::Medium medium;
  shared::Oneil constants;
  std::vector<std::array<float, 4>> table;  // constants.table_size squared; one entry of zeros if not used
  // Over all cosines at sea level, and over altitudes as well: to three scale heights.
  ColumnError rayleigh_at_sea_level, mie_at_sea_level, rayleigh, mie;
};

// Returns the atmosphere of the parameters, as make_oneil() reads it.
[[nodiscard]] shared::Medium oneil_medium(const Params& params);

// Fits the scale functions or fills the table, and measures their errors: takes milliseconds.
[[nodiscard]] OneilModel make_oneil(const shared::Medium& medium, const OneilSettings& settings);

// The errors in words, one line, for notes and reports.
[[nodiscard]] std::string describe_errors(const OneilModel& model);

[[nodiscard]] Answer oneil(const OneilModel& model, const Ray& ray);
// Horizontal irradiance / E0 of the sky at an altitude, from 2 nodes^2 rays.
[[nodiscard]] std::array<double, 3> oneil_sky_irradiance(const OneilModel& model, double altitude_m,
                                                         double cos_sun_zenith, int nodes = 24);
// Of the sun's light to a point: 0 where the planet hides the sun.
[[nodiscard]] std::array<double, 3> oneil_sun_transmittance(const OneilModel& model, double altitude_m,
                                                            double cos_sun_zenith);

// Column of an exponential species outwards from altitude h to `top_m` by quadrature, to 1e-9, relative to its
// density at sea level [m]. cosine >= 0; infinite for a top of infinity.
[[nodiscard]] double exponential_density_integral(double scale_height_m, double radius_m, double altitude_m,
                                                  double cosine, double top_m);

}  // namespace tyndall::models
