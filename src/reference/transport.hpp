// Light transport: what one block of paths of one query adds up to.
#pragma once

#include <cstdint>
#include <span>

#include "reference/atmosphere.hpp"
#include "reference/line.hpp"

namespace tyndall::reference {

// Altitude of the ground sphere that a camera ray meets [m]: sea level, or, for a camera below sea level, twice its
// depth.
inline double ground_altitude_m(double camera_altitude_m) { return 2.0 * std::min(camera_altitude_m, 0.0); }

// A query placed in space: the camera above the planet's pole, the sun in the x-z plane turned by the
// azimuth.
struct Scene {
  Scene(const Atmosphere& air, const RayQuery& query, const Options& options);

  // Whether there is anything to sample; if not, the answer is `ground` alone.
  [[nodiscard]] bool has_air() const { return has_air_; }

  const Atmosphere* air;
  Vec origin, view, sun;         // origin: where the ray enters the atmosphere, or the camera inside it
  double ground_radius_m = 0.0;  // of the sphere that the camera ray ends at
  bool sky = false;
  bool visible_ground = true;
  Rgb transmittance{1.0, 1.0, 1.0};
  Rgb ground{};  // order 1: the sunlit ground at the end of the ray, seen through the air

 private:
  bool has_air_ = false;
};

// The mean over 2^log2_count paths, of each order: means[n - 1] holds n events (without Scene::ground).
// Deterministic in (scene, seed, log2_count, means.size()).
void trace_block(const Scene& scene, std::uint64_t seed, int log2_count, std::span<Rgb> means);

}  // namespace tyndall::reference
