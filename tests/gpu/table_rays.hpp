// Rays inside the atmosphere, for tests of the tables.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "reference/path_tracer.hpp"

namespace tyndall {

constexpr double kPi = 3.14159265358979;
constexpr double kRadians = kPi / 180.0;

inline std::vector<RayQuery> random_rays(std::uint32_t seed, int count, double lowest_sun, double highest_sun) {
  std::mt19937 engine(seed);
  const auto uniform = [&] { return static_cast<double>(engine()) / 4294967296.0; };
  std::vector<RayQuery> out;
  for (int i = 0; i < count; ++i) {
    RayQuery query;
    const double u = uniform();
    query.altitude_m = 70000.0 * (i % 2 == 0 ? u : u * u * u);
    query.view_zenith_rad = std::acos(1.0 - 2.0 * uniform());
    query.sun_zenith_rad = (90.0 - lowest_sun - (highest_sun - lowest_sun) * uniform()) * kRadians;
    query.azimuth_rad = kPi * uniform();
    out.push_back(query);
  }
  return out;
}

}  // namespace tyndall
