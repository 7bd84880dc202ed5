// What the texels of the tables stand for: the coordinates of each, and the factor that makes a physical
// quantity of what it holds. In double precision over shaders/lib, for exports. Pure functions, safe from any
// thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tyndall/params.hpp"

namespace tyndall::models {

// Of the scattering tables. Texels stand for points: these are the coordinates of their centres.
struct TableAxes {
  std::vector<double> altitude_m;
  // The view axis is laid out around the horizon, which depends on altitude: [altitude * views + view].
  std::vector<double> cos_view_zenith;
  std::vector<bool> ends_on_ground;
  std::vector<double> middle_of_air_m;  // along the ray, likewise: where the sun has the angle of the sun axis
  std::vector<double> cos_sun_zenith;
  std::vector<double> cos_view_sun;  // of the angle between view and sun
};
[[nodiscard]] TableAxes table_axes(const Params& params);

// Of the light tables: the sun's cosine is that of the horizon which the altitude sees plus an offset, within
// [-1; 1].
struct LightTableAxes {
  std::vector<double> altitude_m;
  std::vector<double> cos_horizon;  // zenith angle of the horizon, by altitude
  std::vector<double> cos_sun_from_horizon;
};
[[nodiscard]] LightTableAxes light_table_axes(const Params& params, std::uint32_t altitudes, std::uint32_t suns);

// A texel t of the scattering tables means factor * t^4, by altitude and view (as cos_view_zenith):
struct TableFactors {
  std::array<double, 3> single_rayleigh;  // L / E0 over the phase function [1]
  std::array<double, 3> single_mie;       // likewise
  std::array<double, 3> high_orders;      // L / E0 [1/sr]
};
[[nodiscard]] std::vector<TableFactors> table_factors(const Params& params, const TableAxes& axes);

}  // namespace tyndall::models
