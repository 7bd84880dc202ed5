// trace(): checks its input, divides the work into blocks, distributes the blocks over threads, and adds them in a
// fixed order, so that the sums do not depend on the scheduling.
#include "reference/path_tracer.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <numbers>
#include <string>
#include <system_error>
#include <thread>

#include "air/coefficients.hpp"
#include "reference/random.hpp"
#include "reference/transport.hpp"

namespace tyndall::reference {
namespace {

// With this many blocks the standard error is itself accurate to about an eighth.
constexpr std::uint64_t kBlocksWanted = 32;
constexpr int kMaxOrders = 256;
constexpr double kLowestAltitude_m = -11000.0;  // the lowest altitude allowed for a camera
// The largest number of block values in memory before they are added.
constexpr std::size_t kBatchValues = std::size_t{1} << 20;

struct Plan {
  int log2_count = 0;
  std::uint64_t blocks = 1;
};

Plan plan_blocks(std::uint64_t samples) {
  Plan plan;
  while (plan.log2_count < SobolBlock::kMaxLog2Count && (kBlocksWanted << (plan.log2_count + 1)) <= samples) {
    ++plan.log2_count;
  }
  const std::uint64_t count = std::uint64_t{1} << plan.log2_count;
  plan.blocks = std::max<std::uint64_t>(1, (samples - 1) / count + 1);
  return plan;
}

bool within(double value, double low, double high) { return value >= low && value <= high; }

std::string check_query(const RayQuery& q, double radius_m) {
  if (!std::isfinite(q.altitude_m) || q.altitude_m < std::max(kLowestAltitude_m, -0.25 * radius_m)) {
    return "altitude_m is out of range; expected at least -11000 and at least minus a quarter of the planet's radius";
  }
  if (q.altitude_m > 1e6 * radius_m)
    return "altitude_m is out of range; expected at most a million radii of the planet";
  if (!within(q.sun_zenith_rad, 0.0, std::numbers::pi)) return "sun_zenith_rad is out of range; expected 0 to pi";
  if (q.sky_irradiance) return {};
  if (!within(q.view_zenith_rad, 0.0, std::numbers::pi)) return "view_zenith_rad is out of range; expected 0 to pi";
  if (!std::isfinite(q.azimuth_rad)) return "azimuth_rad is not finite; expected a finite angle";
  return {};
}

std::string check_options(const Options& options) {
  if (options.samples < 1 || options.samples > (std::uint64_t{1} << 48)) {
    return "samples is out of range; expected 1 to 2^48";
  }
  if (options.orders < 1 || options.orders > kMaxOrders) return "orders is out of range; expected 1 to 256";
  if (options.stride < 1) return "stride is out of range; expected at least 1";
  if (options.threads < 0 || options.threads > 4096) return "threads is out of range; expected 0 to 4096";
  return {};
}

// Returns which parameter is out of range, or an empty string. Checks the two groups that the path tracer reads.
std::string problem_of(const Params& params) {
  const char* base = reinterpret_cast<const char*>(&params);
  for (const ParamInfo& info : param_table()) {
    if (info.group != "planet" && info.group != "atmosphere") continue;
    const bool vector = info.type == ParamType::vec3;
    if (!vector && info.type != ParamType::float32) continue;
    const float* value = reinterpret_cast<const float*>(base + info.offset);  // NOLINT
    for (int i = 0; i < (vector ? 3 : 1); ++i) {
      // Bounds in the table are exact decimals; a float may exceed them by its rounding.
      if (!within(value[i], info.min - std::abs(info.min) * 1e-6, info.max + std::abs(info.max) * 1e-6)) {
        return std::string(info.group) + "." + std::string(info.name) + " is out of range; expected " +
               std::to_string(info.min) + " to " + std::to_string(info.max);
      }
    }
  }
  return {};
}

// Mean and spread over the blocks of one query, which are added in order (Welford 1962).
template <std::size_t N>
class Accumulator {
 public:
  // `weights` are those of Wavelengths, or empty.
  Accumulator(std::size_t orders, std::span<const Rgb> weights)
      : orders_(orders), weights_(weights), mean_(orders + 1), spread_(orders + 1) {}

  // Adds a block with one value per order. The entry after the orders accumulates their total.
  void add(std::span<const Light<N>> block) {
    ++count_;
    const double weight = 1.0 / static_cast<double>(count_);
    Light<N> total{};
    for (std::size_t n = 0; n <= orders_; ++n) {
      for (std::size_t c = 0; c < N; ++c) {
        const double value = n < orders_ ? block[n][c] : total[c];
        if (n < orders_) total[c] += value;
        const double step = value - mean_[n][c];
        mean_[n][c] += step * weight;
        spread_[n][c] += step * (value - mean_[n][c]);
      }
    }
    Rgb sums{};
    for (std::size_t c = 0; c < weights_.size(); ++c) {
      for (std::size_t k = 0; k < 3; ++k) sums[k] += weights_[c][k] * total[c];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double step = sums[k] - sums_mean_[k];
      sums_mean_[k] += step * weight;
      sums_spread_[k] += step * (sums[k] - sums_mean_[k]);
    }
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] const Light<N>& mean(std::size_t n) const { return mean_[n]; }
  [[nodiscard]] Light<N> standard_error(std::size_t n) const { return error_of(spread_[n]); }
  [[nodiscard]] const Rgb& weighted_sums() const { return sums_mean_; }
  [[nodiscard]] Rgb error_of_sums() const { return error_of(sums_spread_); }

 private:
  // Returns the standard error of a mean from the sum of squared deviations; infinite for one block.
  template <std::size_t M>
  [[nodiscard]] Light<M> error_of(const Light<M>& spread) const {
    Light<M> error;
    const double blocks = static_cast<double>(count_);
    for (std::size_t c = 0; c < M; ++c) {
      error[c] =
          count_ < 2 ? std::numeric_limits<double>::infinity() : std::sqrt(spread[c] / (blocks * (blocks - 1.0)));
    }
    return error;
  }

  std::size_t orders_;
  std::span<const Rgb> weights_;
  std::uint64_t count_ = 0;
  std::vector<Light<N>> mean_, spread_;
  Rgb sums_mean_{}, sums_spread_{};
};

// A batch of consecutive (query, block) pairs with their results.
template <std::size_t N>
struct Batch {
  std::uint64_t first = 0, count = 0;
  std::vector<Light<N>> means;
  std::vector<std::uint8_t> done;
};

template <std::size_t N>
class Work {
 public:
  Work(std::span<const Scene<N>> scenes, const Options& options, const Plan& plan, const Progress& progress)
      : scenes_(scenes),
        options_(options),
        plan_(plan),
        progress_(progress),
        orders_(static_cast<std::size_t>(options.orders)) {}

  void run(std::vector<Accumulator<N>>& sums) {
    const std::uint64_t total = plan_.blocks * scenes_.size();
    const unsigned machine = std::max(1U, std::thread::hardware_concurrency());
    const std::uint64_t threads = options_.threads > 0 ? static_cast<std::uint64_t>(options_.threads) : machine;
    const std::uint64_t per_batch = std::max<std::uint64_t>(kBatchValues / orders_, 1);
    for (std::uint64_t first = 0; first < total && !cancelled_; first += per_batch) {
      Batch<N> batch;
      batch.first = first;
      batch.count = std::min(per_batch, total - first);
      batch.means.resize(batch.count * orders_);
      batch.done.resize(batch.count);
      next_ = 0;
      work_on_threads(std::min(threads, batch.count), batch, total);
      for (std::uint64_t i = 0; i < batch.count; ++i) {
        if (batch.done[i] == 0) continue;
        sums[(batch.first + i) / plan_.blocks].add(
            std::span<const Light<N>>(batch.means).subspan(i * orders_, orders_));
      }
    }
  }

 private:
  // Calls work() on several threads; fewer if the system refuses to start one. If a thread throws, the others end, and
  // this function throws the same.
  void work_on_threads(std::uint64_t threads, Batch<N>& batch, std::uint64_t total) {
    std::mutex mutex;
    std::exception_ptr thrown;
    const auto guarded = [&]() noexcept {
      try {
        work(batch, total);
      } catch (...) {
        cancelled_ = true;
        const std::scoped_lock lock(mutex);
        thrown = std::current_exception();
      }
    };
    {
      std::vector<std::jthread> helpers;
      helpers.reserve(threads);
      try {
        for (std::uint64_t i = 1; i < threads; ++i) helpers.emplace_back(guarded);
      } catch (const std::system_error&) {
        // The threads that have started do all the work.
      }
      guarded();
    }
    if (thrown) std::rethrow_exception(thrown);
  }

  void work(Batch<N>& batch, std::uint64_t total) {
    while (!cancelled_) {
      const std::uint64_t i = next_.fetch_add(1);
      if (i >= batch.count) return;
      const std::uint64_t query = (batch.first + i) / plan_.blocks, block = (batch.first + i) % plan_.blocks;
      const Scene<N>& scene = scenes_[query];
      if (scene.has_air()) {
        const std::uint64_t index = options_.first + query * options_.stride;
        trace_block<N>(scene, hash_seed(options_.seed, index, block), plan_.log2_count,
                       std::span(batch.means).subspan(i * orders_, orders_));
      }
      batch.done[i] = 1;
      if (!progress_) continue;
      const std::scoped_lock lock(progress_mutex_);
      if (!cancelled_ && !progress_(static_cast<double>(++finished_) / static_cast<double>(total))) cancelled_ = true;
    }
  }

  std::span<const Scene<N>> scenes_;
  const Options& options_;
  const Plan& plan_;
  const Progress& progress_;
  std::size_t orders_;
  std::atomic<std::uint64_t> next_ = 0;
  std::atomic<bool> cancelled_ = false;
  std::mutex progress_mutex_;
  std::uint64_t finished_ = 0;  // guarded by progress_mutex_
};

Estimate finish(const Accumulator<3>& sums, const Scene<3>& scene, const Options& options, const Plan& plan) {
  const auto orders = static_cast<std::size_t>(options.orders);
  Estimate estimate;
  estimate.samples = sums.count() << plan.log2_count;
  estimate.transmittance = scene.transmittance;
  estimate.radiance = sums.mean(orders);
  estimate.standard_error = scene.has_air() ? sums.standard_error(orders) : Rgb{};
  for (std::size_t c = 0; c < 3; ++c) estimate.radiance[c] += scene.ground[c];
  if (!options.by_order) return estimate;
  for (std::size_t n = 0; n < orders; ++n) {
    estimate.order_radiance.push_back(sums.mean(n));
    estimate.order_standard_error.push_back(scene.has_air() ? sums.standard_error(n) : Rgb{});
  }
  for (std::size_t c = 0; c < 3; ++c) estimate.order_radiance[0][c] += scene.ground[c];
  return estimate;
}

// Returns an empty string if everything is in range, else what is wrong.
std::string check(const Params& params, std::span<const RayQuery> queries, const Options& options) {
  if (const std::string bad = problem_of(params); !bad.empty()) return "Params: " + bad;
  if (const Result<void> consistent = air::check(params); !consistent) return "Params: " + consistent.error().message;
  if (const std::string bad = check_options(options); !bad.empty()) return "reference::Options: " + bad;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const std::string bad = check_query(queries[i], params.planet.radius_m);
    if (!bad.empty()) return "query " + std::to_string(i + 1) + ": " + bad;
  }
  return {};
}

// Checks the arguments of trace_spectrum() in the same way.
std::string check(const Params& params, const Wavelengths& wavelengths, std::span<const RayQuery> queries,
                  const Options& options) {
  std::string bad = check(params, queries, options);
  if (!bad.empty()) return bad;
  if (wavelengths.nm.empty() || wavelengths.nm.size() > kMaxWavelengths) {
    return std::to_string(wavelengths.nm.size()) + " wavelengths; expected 1 to " + std::to_string(kMaxWavelengths);
  }
  if (wavelengths.weights.size() != wavelengths.nm.size()) {
    return std::to_string(wavelengths.weights.size()) + " weights; expected as many as wavelengths, " +
           std::to_string(wavelengths.nm.size());
  }
  for (const double nm : wavelengths.nm) {
    if (const Result<void> known = air::check_wavelength(params, nm); !known) return known.error().message;
  }
  for (const Rgb& weight : wavelengths.weights) {
    if (!std::isfinite(weight[0] + weight[1] + weight[2])) return "a weight is not finite; expected finite weights";
  }
  return {};
}

SpectralEstimate finish_spectrum(const Accumulator<kMaxWavelengths>& sums, const Scene<kMaxWavelengths>& scene,
                                 const Wavelengths& wavelengths, const Options& options, const Plan& plan) {
  SpectralEstimate estimate;
  estimate.samples = sums.count() << plan.log2_count;
  const Light<kMaxWavelengths>& mean = sums.mean(static_cast<std::size_t>(options.orders));
  const Light<kMaxWavelengths> error = sums.standard_error(static_cast<std::size_t>(options.orders));
  estimate.sums = sums.weighted_sums();
  estimate.standard_error = scene.has_air() ? sums.error_of_sums() : Rgb{};
  for (std::size_t c = 0; c < wavelengths.nm.size(); ++c) {
    estimate.radiance.push_back(mean[c] + scene.ground[c]);
    estimate.transmittance.push_back(scene.transmittance[c]);
    estimate.radiance_error.push_back(scene.has_air() ? error[c] : 0.0);
    for (std::size_t k = 0; k < 3; ++k) estimate.sums[k] += wavelengths.weights[c][k] * scene.ground[c];
  }
  return estimate;
}

// Traces all queries in an atmosphere, and passes the results of each to finish(sums, scene, plan).
template <std::size_t N, typename Finish>
auto compute(const Atmosphere& air, std::span<const RayQuery> queries, const Options& options,
             std::span<const Rgb> weights, const Progress& progress, const Finish& finish) {
  std::vector<Scene<N>> scenes;
  scenes.reserve(queries.size() / options.stride + 1);
  for (std::uint64_t i = options.first; i < queries.size(); i += options.stride) {
    scenes.emplace_back(air, queries[i], options);
  }
  const Plan plan = plan_blocks(options.samples);
  std::vector<Accumulator<N>> sums(scenes.size(), Accumulator<N>(static_cast<std::size_t>(options.orders), weights));
  Work<N>(scenes, options, plan, progress).run(sums);
  std::vector<decltype(finish(sums[0], scenes[0], plan))> estimates;
  estimates.reserve(scenes.size());
  for (std::size_t i = 0; i < scenes.size(); ++i) estimates.push_back(finish(sums[i], scenes[i], plan));
  return estimates;
}

double lowest_altitude_m(std::span<const RayQuery> queries) {
  double lowest_m = 0.0;
  for (const RayQuery& query : queries) lowest_m = std::min(lowest_m, ground_altitude_m(query.altitude_m));
  return lowest_m;
}

std::vector<Estimate> compute_rgb(const Params& params, std::span<const RayQuery> queries, const Options& options,
                                  const Progress& progress) {
  const Atmosphere air(params, lowest_altitude_m(queries));
  return compute<3>(air, queries, options, {}, progress,
                    [&](const Accumulator<3>& sums, const Scene<3>& scene, const Plan& plan) {
                      return finish(sums, scene, options, plan);
                    });
}

}  // namespace

std::uint64_t traced_samples(std::uint64_t samples) {
  const Plan plan = plan_blocks(samples);
  return plan.blocks << plan.log2_count;
}

Result<std::vector<Estimate>> trace(const Params& params, std::span<const RayQuery> queries, const Options& options,
                                    const Progress& progress) {
  std::string bad = check(params, queries, options);
  if (!bad.empty()) return Error{ErrorCode::invalid_argument, std::move(bad), 0};
  return compute_rgb(params, queries, options, progress);
}

Result<std::vector<SpectralEstimate>> trace_spectrum(const Params& params, const Wavelengths& wavelengths,
                                                     std::span<const RayQuery> queries, const Options& options,
                                                     const Progress& progress) {
  std::string bad = check(params, wavelengths, queries, options);
  if (!bad.empty()) return Error{ErrorCode::invalid_argument, std::move(bad), 0};
  const Atmosphere air(params, lowest_altitude_m(queries), wavelengths.nm);
  return compute<kMaxWavelengths>(
      air, queries, options, wavelengths.weights, progress,
      [&](const Accumulator<kMaxWavelengths>& sums, const Scene<kMaxWavelengths>& scene, const Plan& plan) {
        return finish_spectrum(sums, scene, wavelengths, options, plan);
      });
}

Result<Estimate> trace(const Params& params, const RayQuery& query, const Options& options, const Progress& progress) {
  const std::span<const RayQuery> one(&query, 1);
  Options whole = options;
  whole.first = 0;
  std::string bad = check(params, one, whole);
  if (!bad.empty()) return Error{ErrorCode::invalid_argument, std::move(bad), 0};
  return compute_rgb(params, one, whole, progress).front();
}

}  // namespace tyndall::reference
