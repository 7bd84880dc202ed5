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
  // The density-weighted mean distance, in the same layout. The sun axis is the sun's zenith angle at this distance.
  std::vector<double> mean_distance_m;
  std::vector<double> cos_sun_zenith;
  std::vector<double> cos_view_sun;  // cosine of the angle between view and sun
};
[[nodiscard]] TableAxes table_axes(const Params& params);

// Axes of the sun transmittance and sky irradiance look-up tables. The cosine of the sun's zenith angle is the sum of
// cos_horizon and cos_sun_from_horizon, clamped to [-1; 1].
struct LightTableAxes {
  std::vector<double> altitude_m;
  std::vector<double> cos_horizon;  // cosine of the horizon's zenith angle, by altitude
  std::vector<double> cos_sun_from_horizon;
};
[[nodiscard]] LightTableAxes light_table_axes(const Params& params, std::uint32_t altitudes, std::uint32_t suns);

// A texel of value t in the scattering tables stands for the quantity factor * t^4; for the higher orders, the quantity
// is also multiplied by angle_shapes(). The factors depend on altitude and view angle and are stored like
// cos_view_zenith.
struct TableFactors {
  std::array<double, 3> single_rayleigh;  // L / E0 over the phase function [1]
  std::array<double, 3> single_mie;       // likewise
  std::array<double, 3> high_orders;      // L / E0 [1/sr]
};
[[nodiscard]] std::vector<TableFactors> table_factors(const Params& params, const TableAxes& axes);
// Returns angle_shape() of shaders/lib/table_values.glsl for each angle between view and sun.
[[nodiscard]] std::vector<std::array<double, 3>> angle_shapes(const Params& params, const TableAxes& axes);

}  // namespace tyndall::models
