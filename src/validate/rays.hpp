// The rays on which models are compared: a fixed set for a seed, spread evenly over each group.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/path_tracer.hpp"

namespace tyndall::validate {

enum class Region : std::uint32_t { ground, air, space };  // 0 to 2 km, 2 to 70 km, 100 to 20 000 km
enum class SunBand : std::uint32_t { up, twilight };       // 0 to 90 deg, 0 to -6 deg
constexpr std::uint32_t kRegions = 3;
constexpr std::uint32_t kSunBands = 2;

struct TestRay {
  RayQuery query;
  Region region = Region::ground;
  SunBand band = SunBand::up;
  // The sun's elevation where the ray begins or, from space, where it is nearest to the ground.
  double sun_elevation_rad = 0.0;
};

// Returns `count` rays of one group. From the ground, they point above the horizon; inside the atmosphere, in all
// directions; from space, half of them hit the ground and half pass its limb below 60 km. `radius_m` and `height_m` are
// those of planet and atmosphere [m]; altitudes made for a height of 80 km are scaled to it.
[[nodiscard]] std::vector<TestRay> make_rays(Region region, SunBand band, std::uint32_t count, std::uint64_t seed,
                                             double radius_m, double height_m);

// Returns `count` rays near the horizon under low suns: from 2 m to 3 km, 0.5 to 5 degrees above the geometric
// horizon, with the sun at 0.5 to 10 degrees or at 0 to -6 degrees. Evenly spread rays rarely include these.
[[nodiscard]] std::vector<TestRay> make_horizon_rays(SunBand band, std::uint32_t count, std::uint64_t seed,
                                                     double radius_m, double height_m);

}  // namespace tyndall::validate
