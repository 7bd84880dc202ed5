// Phase functions per steradian, normalised to 1 over the sphere, and exact sampling of each. `cosine` is that of the
// angle between the directions of flight before and after scattering: +1 is straight ahead.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "tyndall/params.hpp"

namespace tyndall::reference {

// Returns the Rayleigh phase function without depolarisation.
inline double rayleigh_phase(double cosine) { return 3.0 / (16.0 * std::numbers::pi) * (1.0 + cosine * cosine); }

// Maps u in [0; 1) to a cosine with density 3/8 (1 + c^2): the real root of c^3 + 3c = 8u - 4, by Cardano's formula in
// a form without cancellation.
inline double sample_rayleigh(double u) {
  const double z = std::abs(4.0 * u - 2.0);
  const double a = std::cbrt(z + std::sqrt(z * z + 1.0));
  return std::copysign(a - 1.0 / a, u - 0.5);
}

// A phase function that has no formula for sampling: a histogram of its mean over the wavelengths, from which cosines
// are sampled exactly, and the function itself at every wavelength.
class TabulatedPhase {
 public:
  // Evaluates the phase function of the parameters at the wavelengths of the channels. Precondition: air::tabulated().
  TabulatedPhase(const Params& params, std::span<const double> wavelengths_nm);

  // Computes the phase function in all channels: linear in the cosine between nodes that are 0.05 degrees apart, and
  // closer ahead.
  void values(double cosine, std::span<double> channels) const;
  // Returns the probability density of sample() per steradian.
  [[nodiscard]] double density(double cosine) const;
  // Maps u in [0; 1) to a cosine.
  [[nodiscard]] double sample(double u) const;

 private:
  [[nodiscard]] std::size_t bin_of(double cosine) const;

  std::size_t channels_;
  std::vector<double> cosines_;     // ends of the bins, decreasing from 1 to -1
  std::vector<double> values_;      // at the ends of the bins, channel by channel
  std::vector<double> densities_;   // probability density of each bin, per steradian
  std::vector<double> cumulative_;  // for each bin, the probability of all bins before it
};

// The aerosol's phase function with precomputed constants.
class MiePhaseFunction {
 public:
  MiePhaseFunction() = default;
  MiePhaseFunction(MiePhase kind, double g)
      : g_(g), one_plus_g2_(1.0 + g * g), cornette_shanks_(kind == MiePhase::cornette_shanks) {
    const double isotropic = 1.0 / (4.0 * std::numbers::pi);
    scale_ = isotropic * (1.0 - g * g);
    if (cornette_shanks_) scale_ *= 1.5 / (2.0 + g * g);
  }
  explicit MiePhaseFunction(std::shared_ptr<const TabulatedPhase> table) : table_(std::move(table)) {}

  // Returns the function of Henyey and Greenstein (1941), or of Cornette and Shanks (1992, equation 8).
  [[nodiscard]] double operator()(double cosine) const {
    const double base = one_plus_g2_ - 2.0 * g_ * cosine;
    const double value = scale_ / (base * std::sqrt(base));
    return cornette_shanks_ ? value * (1.0 + cosine * cosine) : value;
  }

  // Evaluates any function in all channels. Returns the probability density with which sample() chooses the cosine.
  double evaluate(double cosine, std::span<double> channels) const {
    if (table_) {
      table_->values(cosine, channels);
      return table_->density(cosine);
    }
    const double value = (*this)(cosine);
    std::fill(channels.begin(), channels.end(), value);
    return value;
  }

  // Maps u in [0; 1) to a cosine; `random()` yields further numbers in [0; 1). Cornette-Shanks is Henyey-Greenstein
  // times (1 + c^2) / 2 <= 1, so rejection sampling is exact; at least 2/3 of the candidates are accepted.
  template <typename Random>
  [[nodiscard]] double sample(double u, Random&& random) const {
    if (table_) return table_->sample(u);
    double cosine = henyey_greenstein_cosine(u);
    while (cornette_shanks_ && random() * 2.0 > 1.0 + cosine * cosine) {
      cosine = henyey_greenstein_cosine(random());
    }
    return cosine;
  }

 private:
  [[nodiscard]] double henyey_greenstein_cosine(double u) const {
    const double t = 2.0 * u - 1.0;
    if (std::abs(g_) < 1e-6) return std::clamp(t + 1.5 * g_ * (1.0 - t * t), -1.0, 1.0);  // error O(g^2)
    const double q = (1.0 - g_ * g_) / (1.0 + g_ * t);
    return std::clamp((one_plus_g2_ - q * q) / (2.0 * g_), -1.0, 1.0);
  }

  double g_ = 0.0, one_plus_g2_ = 1.0, scale_ = 0.0;
  bool cornette_shanks_ = false;
  std::shared_ptr<const TabulatedPhase> table_ = nullptr;
};

}  // namespace tyndall::reference
