// Light transport of one block of paths of one query, instantiated for 3 channels and for kMaxWavelengths.
#pragma once

#include <cstdint>
#include <span>

#include "reference/atmosphere.hpp"
#include "reference/line.hpp"

namespace tyndall::reference {

// Returns the altitude of the ground sphere that a camera ray can hit [m]: sea level or, for a camera below sea level,
// twice its depth.
inline double ground_altitude_m(double camera_altitude_m) { return 2.0 * std::min(camera_altitude_m, 0.0); }

// One value per channel. Light of fewer channels than N is 0 in the others.
template <std::size_t N>
using Light = std::array<double, N>;

// A query in world space: the camera is above the planet's pole, the sun is in the x-z plane rotated by the azimuth.
template <std::size_t N>
struct Scene {
  Scene(const Atmosphere& air, const RayQuery& query, const Options& options);

  // Returns whether there is anything to sample. If not, `ground` is the result.
  [[nodiscard]] bool has_air() const { return has_air_; }

  const Atmosphere* air;
  Vec origin, view, sun;         // origin: where the ray enters the atmosphere, or the camera inside it
  double ground_radius_m = 0.0;  // radius of the sphere at which the camera ray ends
  bool sky = false;
  bool visible_ground = true;
  Light<N> transmittance{};
  Light<N> ground{};  // radiance of the sunlit ground at the end of the ray, attenuated; part of order 1

 private:
  bool has_air_ = false;
};

// Computes the mean of each order over 2^log2_count paths: means[n - 1] is the radiance after n events, without
// Scene::ground.
// Deterministic in (scene, seed, log2_count, means.size()).
template <std::size_t N>
void trace_block(const Scene<N>& scene, std::uint64_t seed, int log2_count, std::span<Light<N>> means);

}  // namespace tyndall::reference
