// Prepares the tables of an effect: loads them from the cache on disk, or builds them and stores them there. Uses the
// public interface of the effect only, so an engine can do the same.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "gpu/host.hpp"
#include "tyndall/effect.hpp"

namespace tyndall::tables {

struct CacheDesc {
  std::string place = "off";  // as in files::cache_directory
  std::uint64_t limit_bytes = std::uint64_t{1} << 30U;
};

enum class Origin {
  unchanged,  // the tables were already complete
  cache,
  build,
};

struct MakeReady {
  CacheDesc cache;
  std::function<void(Progress)> progress;  // called between the slices of a build; may be empty
  std::uint32_t slice_budget = 8;          // slices per submission
  bool rebuild = false;                    // ignore cached tables, but store the result
};

struct Report {
  Origin origin = Origin::unchanged;
  double milliseconds = 0.0;       // until the tables were usable, without the time to store them
  std::vector<std::string> notes;  // remarks on cache errors, one line each; these never fail a run
};

// Records, submits and waits until the tables of effect.params() are complete.
Result<Report> make_ready(gpu::Host& host, Effect& effect, const MakeReady& how);

// Makes one step towards complete tables, for programs that draw meanwhile: loads them from the cache, or builds at
// most `budget` slices. Does not store them in the cache (see CacheWriter). Adds remarks to `notes`.
Result<void> advance(gpu::Host& host, Effect& effect, const MakeReady& how, std::uint32_t budget,
                     std::vector<std::string>& notes);

// Copies finished tables into the cache. fetch() reads them back from the device; write() may run on another thread.
class CacheWriter {
 public:
  static Result<CacheWriter> fetch(gpu::Host& host, Effect& effect, const CacheDesc& cache);
  // Returns a remark about an error, or an empty string.
  [[nodiscard]] std::string write();

 private:
  CacheDesc cache_;
  std::string key_;
  std::vector<std::byte> bytes_;
};

}  // namespace tyndall::tables
