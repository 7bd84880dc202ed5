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
  // Of the sun where the ray begins, or from space where it comes nearest to the ground.
  double sun_elevation_rad = 0.0;
};

// `count` rays of one group. From the ground all directions above the horizontal, from the air all, from
// space half of them at the ground and half past its limb at less than 60 km. A planet of this radius with an
// atmosphere of this height [m]; the altitudes are fractions of it made for 80 km.
[[nodiscard]] std::vector<TestRay> make_rays(Region region, SunBand band, std::uint32_t count, std::uint64_t seed,
                                             double radius_m, double height_m);

// `count` rays of low suns near the horizon: from 0 to 1 km, 0.5 to 5 degrees above the geometric horizon, the sun at 0
// to 10 degrees or at 0 to -6. Evenly spread rays hardly ever meet these.
[[nodiscard]] std::vector<TestRay> make_horizon_rays(SunBand band, std::uint32_t count, std::uint64_t seed,
                                                     double radius_m, double height_m);

}  // namespace tyndall::validate
