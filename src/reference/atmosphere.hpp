// The medium of the path tracer: coefficients of src/air, densities and optical depth. Density integrals (path
// integrals of relative density, in metres) towards the top of the atmosphere come from a table for the two exponential
// profiles, built here in double precision, and in closed form for ozone. Immutable after construction, so threads may
// share it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "reference/geometry.hpp"
#include "reference/path_tracer.hpp"
#include "reference/phase.hpp"

namespace tyndall::reference {

// One number per species: relative densities, or density integrals in m.
struct Amounts {
  double rayleigh = 0.0, mie = 0.0, ozone = 0.0;
};
inline Amounts operator+(const Amounts& a, const Amounts& b) {
  return {a.rayleigh + b.rayleigh, a.mie + b.mie, a.ozone + b.ozone};
}
inline Amounts operator-(const Amounts& a, const Amounts& b) {
  return {a.rayleigh - b.rayleigh, a.mie - b.mie, a.ozone - b.ozone};
}

// The properties of the atmosphere that depend on the wavelength.
struct AtmosphereChannels {
  using PerChannel = std::array<double, kMaxWavelengths>;  // 0 beyond `channels`
  std::size_t channels = 3;
  // Coefficients in 1/m at relative density 1.
  PerChannel rayleigh_scattering{}, mie_scattering{}, mie_extinction{}, ozone_absorption{};
  PerChannel ground_albedo{};

  // Returns whether the ground is not black.
  [[nodiscard]] bool reflects() const { return *std::max_element(ground_albedo.begin(), ground_albedo.end()) > 0.0; }
};

class Atmosphere : public AtmosphereChannels {
 public:
  // Builds the table for points at `lowest_m` [m, <= 0] and above. The density profiles continue below sea level. The
  // channels are those of the parameters or, if wavelengths are given, one for each of them.
  explicit Atmosphere(const Params& params, double lowest_m = 0.0, std::span<const double> wavelengths_nm = {});

  // Lengths in m.
  double radius_m, top_radius_m, height_m;
  double rayleigh_scale_height_m, mie_scale_height_m;
  // Light that passes the planet's centre closer than this radius is mostly absorbed. Where a sphere of this radius
  // hides the sun, the sun is practically set. Only the sampling uses it.
  double opaque_radius_m;
  MiePhaseFunction mie_phase;

  // Returns the relative densities at radius r, without ozone, which does not scatter. They are bounded, so that they
  // stay finite deep below ground and for small scale heights; a medium of that density is opaque anyway.
  [[nodiscard]] Amounts density(double r) const {
    constexpr double kDensest = 60.0;  // largest exponent
    const double h = r - radius_m;
    return {std::exp(std::min(-h / rayleigh_scale_height_m, kDensest)),
            std::exp(std::min(-h / mie_scale_height_m, kDensest)), 0.0};
  }
  [[nodiscard]] bool reaches_ozone(double r) const { return has_ozone_ && r > ozone_low_m_; }

  // Returns the density integrals from position s >= 0 of a line (geometry.hpp) to the top of the atmosphere, which the
  // line crosses at s_top >= s. `density` holds the densities at s.
  [[nodiscard]] Amounts density_integrals_to_top(double tangent2, double s, double s_top,
                                                 const Amounts& density) const {
    Amounts integrals = exponential_density_integrals(tangent2, s, s_top, density);
    integrals.ozone = ozone_density_integral(tangent2, s, s_top);
    return integrals;
  }
  // Returns the same without ozone, which stays 0.
  [[nodiscard]] Amounts exponential_density_integrals(double tangent2, double s, double s_top,
                                                      const Amounts& density) const;
  [[nodiscard]] double ozone_density_integral(double tangent2, double s, double s_top) const;

  [[nodiscard]] double transmittance(const Amounts& integrals, std::size_t channel) const {
    return std::exp(-optical_depth(integrals, channel));
  }
  [[nodiscard]] double optical_depth(const Amounts& integrals, std::size_t channel) const {
    return exponential_depth(integrals, channel) + ozone_absorption[channel] * integrals.ozone;
  }
  // Returns the optical depth without ozone. Given densities instead of integrals: the extinction coefficient.
  [[nodiscard]] double exponential_depth(const Amounts& integrals, std::size_t channel) const {
    return rayleigh_scattering[channel] * integrals.rayleigh + mie_extinction[channel] * integrals.mie;
  }

 private:
  void build_table();
  [[nodiscard]] double find_opaque_radius() const;

  // The ozone profile: density rises linearly from 0 at `low` to 1 at `centre` and falls to 0 at `high` (radii).
  double base_radius_m_;  // radius of the lowest points
  double ozone_low_m_, ozone_centre_m_, ozone_high_m_, ozone_half_width_m_;
  bool has_ozone_;
  // table_[ih * nx + ix] holds the mean Rayleigh and Mie densities between a point and the top of the atmosphere,
  // relative to the densities at the point. The point is at radius base + ih / (nh - 1) * (top - base). The path has
  // the length shortest + ix / (nx - 1) * (longest - shortest): the shortest is vertical, the longest horizontal.
  struct MeanDensity {
    double rayleigh, mie;
  };
  std::size_t nh_ = 0, nx_ = 0;
  std::vector<MeanDensity> table_;
};

}  // namespace tyndall::reference
