// Importance sampling of twilight: after sunset, light comes from above the horizon on the sun's side, so a part of the
// sampled directions goes there.
#pragma once

#include <algorithm>
#include <cmath>

#include "reference/geometry.hpp"
#include "reference/phase.hpp"

namespace tyndall::reference {

// A lobe around the horizontal direction towards the sun, with its lower half mirrored upwards.
struct Glow {
  Vec up, axis;
  double fraction = 0.0;  // fraction of the directions; 0 while the sun is up

  // `vertical` is the unit vector away from the planet's centre.
  Glow(const Vec& vertical, const Vec& sun) : up(vertical) {
    const double height = dot(up, sun);
    const Vec level = sun + up * -height;
    if (height >= 0.0 || dot(level, level) < 1e-6) return;
    axis = normalized(level);
    fraction = 0.35;
  }

  // Samples a direction. u is in [0; 1), turn in radians; `random()` yields further numbers in [0; 1).
  template <typename Random>
  [[nodiscard]] Vec sample(double u, double turn, Random&& random) const {
    const Vec w = around(axis, kLobe.sample(u, random), std::cos(turn), std::sin(turn));
    return w + up * (-2.0 * std::min(0.0, dot(w, up)));
  }
  // Returns the probability density per steradian. It integrates to 1 unless the fraction is 0.
  [[nodiscard]] double density(const Vec& w) const {
    return fraction > 0.0 && dot(w, up) >= 0.0 ? 2.0 * kLobe(dot(w, axis)) : 0.0;
  }

 private:
  static inline const MiePhaseFunction kLobe{MiePhase::henyey_greenstein, 0.75};
};

}  // namespace tyndall::reference
