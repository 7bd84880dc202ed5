// The coordinates of the tables' texels, and the factor that converts a texel to a physical quantity. In double
// precision from shaders/lib, for exports. Pure functions, safe from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tyndall/params.hpp"

namespace tyndall::models {

// Axes of the scattering tables: the coordinates of the texel centres.
struct TableAxes {
  std::vector<double> altitude_m;
  // The view axis is relative to the horizon, which depends on altitude: [altitude * views + view].
  std::vector<double> cos_view_zenith;
  std::vector<bool> ends_on_ground;
  std::vector<double> mean_distance_m;  // density-weighted, same layout: the sun axis refers to the sun there
  std::vector<double> cos_sun_zenith;
  std::vector<double> cos_view_sun;  // of the angle between view and sun
};
[[nodiscard]] TableAxes table_axes(const Params& params);

// Axes of the sun transmittance and sky irradiance look-up tables. The sun's cosine is that of the horizon as seen from
// the altitude, plus an offset, within [-1; 1].
struct LightTableAxes {
  std::vector<double> altitude_m;
  std::vector<double> cos_horizon;  // of the horizon's zenith angle, by altitude
  std::vector<double> cos_sun_from_horizon;
};
[[nodiscard]] LightTableAxes light_table_axes(const Params& params, std::uint32_t altitudes, std::uint32_t suns);

// A texel t of the scattering tables stands for factor * t^4. By altitude and view, like cos_view_zenith.
struct TableFactors {
  std::array<double, 3> single_rayleigh;  // L / E0 over the phase function [1]
  std::array<double, 3> single_mie;       // likewise
  std::array<double, 3> high_orders;      // L / E0 [1/sr]
};
[[nodiscard]] std::vector<TableFactors> table_factors(const Params& params, const TableAxes& axes);

}  // namespace tyndall::models
