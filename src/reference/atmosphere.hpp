// The medium of the path tracer: coefficients derived from Params, densities, and optical depth.
// Columns (path integrals of relative density, in metres) towards the top of the atmosphere come from
// a table for the two exponential profiles, built here in double precision, and in closed form for
// ozone. Immutable after construction, hence free to share between threads.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "reference/geometry.hpp"
#include "reference/path_tracer.hpp"
#include "reference/phase.hpp"

namespace tyndall::reference {

// One number for each kind of matter: relative densities, or columns in m.
struct Amounts {
  double rayleigh = 0.0, mie = 0.0, ozone = 0.0;
};
inline Amounts operator+(const Amounts& a, const Amounts& b) {
  return {a.rayleigh + b.rayleigh, a.mie + b.mie, a.ozone + b.ozone};
}
inline Amounts operator-(const Amounts& a, const Amounts& b) {
  return {a.rayleigh - b.rayleigh, a.mie - b.mie, a.ozone - b.ozone};
}

class Atmosphere {
 public:
  // For points from `lowest_m` [m, <= 0] above sea level upwards; the densities continue below sea level as above it.
  explicit Atmosphere(const Params& params, double lowest_m = 0.0);

  // Lengths in m, coefficients in 1/m at relative density 1.
  double radius_m, top_radius_m, height_m;
  double rayleigh_scale_height_m, mie_scale_height_m;
  Rgb rayleigh_scattering, mie_scattering, mie_extinction, ozone_absorption;
  double ground_albedo;
  // Light that passes the planet closer than this (a radius) is mostly lost in the air: where the sun is
  // hidden by a sphere of this radius it is as good as set. Guides the sampling, nothing else.
  double opaque_radius_m;
  MiePhaseFunction mie_phase;

  // Relative densities at radius r (ozone left out: it does not scatter). They stay finite however deep the point and
  // small the scale height: by far nothing gets through what is that dense.
  [[nodiscard]] Amounts density(double r) const {
    constexpr double kDensest = 60.0;  // exponent
    const double h = r - radius_m;
    return {std::exp(std::min(-h / rayleigh_scale_height_m, kDensest)),
            std::exp(std::min(-h / mie_scale_height_m, kDensest)), 0.0};
  }
  // Relative density of ozone at radius r.
  [[nodiscard]] double ozone_density(double r) const;

  [[nodiscard]] bool reaches_ozone(double r) const { return has_ozone_ && r > ozone_low_m_; }

  // Columns from position s >= 0 of a line (see geometry.hpp) to the top of the atmosphere, which the
  // line crosses at s_top >= s. `density` are the densities at s.
  [[nodiscard]] Amounts columns_to_top(double tangent2, double s, double s_top, const Amounts& density) const {
    Amounts columns = exponential_columns(tangent2, s, s_top, density);
    columns.ozone = ozone_density_integral(tangent2, s, s_top);
    return columns;
  }
  // The same without ozone, which is left 0.
  [[nodiscard]] Amounts exponential_columns(double tangent2, double s, double s_top, const Amounts& density) const;
  [[nodiscard]] double ozone_density_integral(double tangent2, double s, double s_top) const;

  [[nodiscard]] double transmittance(const Amounts& columns, std::size_t channel) const {
    return std::exp(-optical_depth(columns, channel));
  }
  [[nodiscard]] double optical_depth(const Amounts& columns, std::size_t channel) const {
    return exponential_depth(columns, channel) + ozone_absorption[channel] * columns.ozone;
  }
  // Optical depth without ozone. With densities instead of columns: the extinction coefficient.
  [[nodiscard]] double exponential_depth(const Amounts& columns, std::size_t channel) const {
    return rayleigh_scattering[channel] * columns.rayleigh + mie_extinction[channel] * columns.mie;
  }

 private:
  void build_table();
  [[nodiscard]] double find_opaque_radius() const;

  // Ozone: density rises linearly from 0 at `low` to 1 at `centre` and falls to 0 at `high` (radii).
  double base_radius_m_;  // of the lowest points
  double ozone_low_m_, ozone_centre_m_, ozone_high_m_, ozone_half_width_m_;
  bool has_ozone_;
  // table_[ih * nx + ix]: mean densities of Rayleigh and Mie between a point and the top, relative to
  // the densities at the point, at radius base + ih / (nh - 1) * (top - base) and path length
  // shortest + ix / (nx - 1) * (longest - shortest), longest being the horizontal path.
  struct MeanDensity {
    double rayleigh, mie;
  };
  std::size_t nh_ = 0, nx_ = 0;
  std::vector<MeanDensity> table_;
};

}  // namespace tyndall::reference
