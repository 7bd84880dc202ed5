// The judge: an unbiased Monte Carlo path tracer for a spherical-shell atmosphere, in double precision
// on the CPU, written independently of shaders/lib so that one mistake cannot hide in both.
// Radiance is relative to the sun's irradiance above the atmosphere (sr^-1). The sun is a point in
// direction and is never seen directly. Everything is seeded: results do not depend on the number of
// threads. Thread rule: trace() may be called from several threads at once; it keeps no state.
// The estimator is described in docs/reference.md.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "rays/ray_query.hpp"
#include "tyndall/params.hpp"
#include "tyndall/result.hpp"

namespace tyndall::reference {

using Rgb = std::array<double, 3>;  // one value per channel of atmosphere.wavelengths_nm

struct Options {
  // Paths per query, >= 1. Rounded to a number of equal blocks, see Estimate::samples.
  std::uint64_t samples = 100000;
  // Light is followed over 1 to `orders` events; an event is a scattering in the air or a reflection
  // at the ground. 1 is single scattering (and, where the ray ends there, the ground lit by the sun alone).
  int orders = 8;  // [1; 256]
  std::uint64_t seed = 1;
  int threads = 0;        // 0: as many as the machine has
  bool by_order = false;  // fill Estimate::order_*
  // Whether the ground at the end of a ray belongs to its radiance. false leaves the light that the
  // air alone sends to the eye (ground reflections before that are kept); transmittance then weighs
  // whatever stands behind the air.
  bool visible_ground = true;
};

struct Estimate {
  Rgb radiance{};        // L / E0, sr^-1; for the sky E / E0
  Rgb standard_error{};  // of radiance, from independent blocks; 0 if it has no variance, infinite with one
                         // block
  // Deterministic. Along the ray to its end: the ground, or the top of the atmosphere (1 if the ray
  // misses it). For the sky: towards the sun, 0 where the planet hides it.
  Rgb transmittance{};
  std::uint64_t samples = 0;              // paths that went in; less than asked only after a cancelled call
  std::vector<Rgb> order_radiance;        // with by_order: order_radiance[n - 1] holds n events
  std::vector<Rgb> order_standard_error;  // likewise
};

// Called now and then, by one thread at a time, with the part done in [0; 1]; false cancels the call.
using Progress = std::function<bool(double done)>;

// Below sea level the atmosphere continues, the camera ray meets ground at twice the depth of the camera, and light
// that arrives from below at any other point comes from ground at that point (docs/adr/0007-below-sea-level.md). One
// estimate per query, in their order. Query i uses random numbers of its own, a function of (seed, i): equal queries in
// one call are independent estimates. A cancelled call returns what is done: look at Estimate::samples. Errors:
// invalid_argument for a query, an option or a parameter out of its range.
Result<std::vector<Estimate>> trace(const Params& params, std::span<const RayQuery> queries, const Options& options,
                                    const Progress& progress = {});

// The same for one query (index 0).
Result<Estimate> trace(const Params& params, const RayQuery& query, const Options& options,
                       const Progress& progress = {});

}  // namespace tyndall::reference
