// The reference: an unbiased Monte Carlo path tracer for a spherical-shell atmosphere, in double precision on the CPU.
// It is written independently of shaders/lib, so that the two do not share mistakes.
// Radiance is relative to the sun's irradiance above the atmosphere [1/sr]. The sun is a point in direction and is
// never seen directly. All random numbers are seeded; results do not depend on the number of threads. trace() has no
// state and may be called from several threads at once. docs/reference.md describes the estimator.
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
constexpr std::size_t kMaxWavelengths = 40;

struct Options {
  // Paths per query, >= 1. Rounded up to a whole number of equal blocks, see Estimate::samples.
  std::uint64_t samples = 100000;
  // Light is followed over 1 to `orders` events: scattering in the atmosphere or reflection at the ground. 1 is single
  // scattering, plus sunlit ground where the ray ends there.
  int orders = 8;  // [1; 256]
  std::uint64_t seed = 1;
  int threads = 0;        // 0: one per hardware thread
  bool by_order = false;  // fill Estimate::order_*
  // True if the ground at the end of a ray contributes to its radiance. Otherwise only in-scattered light does,
  // including light that the ground reflected before; transmittance then applies to whatever is behind the atmosphere.
  bool visible_ground = true;
  // Which of the queries are traced: those with the indices first, first + stride, first + 2 stride and so on.
  // Together, calls with all values of `first` below `stride` give the same estimates as one call for all queries.
  std::uint64_t first = 0;
  std::uint64_t stride = 1;  // >= 1
};

struct Estimate {
  Rgb radiance{};        // L / E0, sr^-1; for the sky E / E0
  Rgb standard_error{};  // of radiance, from independent blocks; 0 without variance, infinite for one block
  // Transmittance along the ray to its end: the ground, or the top of the atmosphere (1 if the ray misses it). For the
  // sky: towards the sun, 0 if the planet hides it. Deterministic.
  Rgb transmittance{};
  std::uint64_t samples = 0;              // paths traced; fewer than requested only after a cancelled call
  std::vector<Rgb> order_radiance;        // with by_order: order_radiance[n - 1] is the radiance after n events
  std::vector<Rgb> order_standard_error;  // with by_order: the standard errors of order_radiance
};

// Called from time to time, by one thread at a time, with the completed fraction in [0; 1]. Returning false cancels.
using Progress = std::function<bool(double done)>;

// Returns the number of paths per query that are traced for Options::samples.
[[nodiscard]] std::uint64_t traced_samples(std::uint64_t samples);

// Returns one estimate per traced query, in order. Query i has its own random numbers, a function of (seed, i), so
// equal queries in one call give independent estimates. A cancelled call returns what is complete: see
// Estimate::samples. Below sea level the atmosphere continues, and the camera ray hits ground at twice the depth of the
// camera. Light that arrives from below at any other point comes from ground at that point
// (docs/adr/0007-below-sea-level.md). Errors: invalid_argument for a query, option or parameter out of range, and for
// parameters that contradict each other.
Result<std::vector<Estimate>> trace(const Params& params, std::span<const RayQuery> queries, const Options& options,
                                    const Progress& progress = {});

// The wavelengths of trace_spectrum().
struct Wavelengths {
  std::span<const double> nm;  // [100; 4000] or the range of cross-sections - 1 to kMaxWavelengths of them
  // Weights of three sums over the wavelengths, such as X, Y and Z: finite, one entry for each wavelength.
  std::span<const Rgb> weights;
};

// Light at any wavelengths, in the units of Estimate, for each of Wavelengths::nm.
struct SpectralEstimate {
  std::vector<double> radiance, transmittance;
  // Standard errors of the radiance, from independent blocks. The errors of neighbouring wavelengths are similar,
  // because all wavelengths follow the same paths.
  std::vector<double> radiance_error;
  // The three weighted sums of the radiance and their standard errors.
  Rgb sums{};
  Rgb standard_error{};
  std::uint64_t samples = 0;
};

// Traces light at other wavelengths than those of the channels, all of them along the same paths, as trace() does for
// three. The coefficients at a wavelength are those of air/coefficients.hpp. Options::by_order has no effect.
// Errors: those of trace(), and invalid_argument for the wavelengths.
Result<std::vector<SpectralEstimate>> trace_spectrum(const Params& params, const Wavelengths& wavelengths,
                                                     std::span<const RayQuery> queries, const Options& options,
                                                     const Progress& progress = {});

// Traces a single query; its index is 0.
Result<Estimate> trace(const Params& params, const RayQuery& query, const Options& options,
                       const Progress& progress = {});

}  // namespace tyndall::reference
