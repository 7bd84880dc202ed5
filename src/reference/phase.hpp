// Phase functions per steradian, normalised to 1 over the sphere, and exact sampling of each. `cosine` is that of the
// angle between the directions of flight before and after scattering: +1 is straight ahead.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

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

  // Returns the function of Henyey and Greenstein (1941), or of Cornette and Shanks (1992, equation 8).
  [[nodiscard]] double operator()(double cosine) const {
    const double base = one_plus_g2_ - 2.0 * g_ * cosine;
    const double value = scale_ / (base * std::sqrt(base));
    return cornette_shanks_ ? value * (1.0 + cosine * cosine) : value;
  }

  // Maps u in [0; 1) to a cosine; `random()` yields further numbers in [0; 1). Cornette-Shanks is Henyey-Greenstein
  // times (1 + c^2) / 2 <= 1, so rejection sampling is exact; at least 2/3 of the candidates are accepted.
  template <typename Random>
  [[nodiscard]] double sample(double u, Random&& random) const {
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
};

}  // namespace tyndall::reference
