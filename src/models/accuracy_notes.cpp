#include "models/accuracy_notes.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "air/coefficients.hpp"
#include "effect/medium.hpp"

namespace tyndall::models {
namespace {

// Returns the largest vertical optical depth of scattering in the three channels.
double scattering_depth(const Params& params) {
  const shared::Medium medium = medium_from_params(params);
  const double rayleigh_m = air::exponential_column_m(params, static_cast<double>(medium.rayleigh_scale_height_m));
  const double mie_m = air::exponential_column_m(params, static_cast<double>(medium.mie_scale_height_m));
  const shared::vec3 &rayleigh = medium.rayleigh_scattering, &mie = medium.mie_scattering;
  const std::array<double, 3> depths = {
      static_cast<double>(rayleigh.x) * rayleigh_m + static_cast<double>(mie.x) * mie_m,
      static_cast<double>(rayleigh.y) * rayleigh_m + static_cast<double>(mie.y) * mie_m,
      static_cast<double>(rayleigh.z) * rayleigh_m + static_cast<double>(mie.z) * mie_m};
  return *std::max_element(depths.begin(), depths.end());
}

std::string rounded(double value, int decimals) {
  std::array<char, 64> text = {};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

}  // namespace

std::vector<std::string> accuracy_notes(const Params& params, bool from_tables) {
  constexpr double kThick = 2.0;
  // Above it, the vertical optical depth is wrong by more than 0.3 %; at 0.8 by 5 %.
  constexpr double kHigh = 0.16;
  std::vector<std::string> out;
  const double depth = from_tables ? scattering_depth(params) : 0.0;
  if (depth > kThick) {
    out.push_back("the atmosphere scatters with a vertical optical depth of " + rounded(depth, 1) +
                  "; the tables hold only tables.orders orders of scattering, so results from them are too dark "
                  "(docs/air.md)");
  }
  const double radius_m = static_cast<double>(params.planet.radius_m);
  const double scale_m =
      static_cast<double>(std::max(params.atmosphere.rayleigh_scale_height_m, params.atmosphere.mie_scale_height_m));
  if (scale_m > kHigh * radius_m) {
    out.push_back("a scale height of " + rounded(scale_m, 0) + " m is more than 0.16 of planet.radius_m; " +
                  "optical depths are too large (docs/air.md)");
  }
  return out;
}

}  // namespace tyndall::models
