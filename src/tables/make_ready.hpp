// Makes the tables of an effect ready: from the cache on disk if they are there, otherwise by building them,
// after which they are kept there. What every program here does before it asks for light; an engine can do
// the same with the public interface.
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
  unchanged,  // they were ready
  cache,
  build,
};

struct MakeReady {
  CacheDesc cache;
  std::function<void(Progress)> progress;  // of a build, between its slices; may be empty
  std::uint32_t slice_budget = 8;          // slices per submission
  bool build_anew = false;                 // do not look into the cache, but keep the result there
};

struct Outcome {
  Origin origin = Origin::unchanged;
  double milliseconds = 0.0;       // until they could be used, keeping them not included
  std::vector<std::string> notes;  // about trouble with the cache, one line each; it never fails a run
};

// Records, submits and waits until the tables of effect.params() are complete.
Result<Outcome> make_ready(gpu::Host& host, Effect& effect, const MakeReady& how);

// One step of the same, for programs that draw meanwhile: loads the tables from the cache, or else builds at most
// `budget` slices. Keeps nothing in the cache: see keep(). Remarks are added to `notes`.
Result<void> advance(gpu::Host& host, Effect& effect, const MakeReady& how, std::uint32_t budget,
                     std::vector<std::string>& notes);

// Finished tables on their way into the cache. fetch() reads them back from the device; write() may run on a
// thread of its own.
class Keeper {
 public:
  static Result<Keeper> fetch(gpu::Host& host, Effect& effect, const CacheDesc& cache);
  // The remark about trouble, or nothing.
  [[nodiscard]] std::string write();

 private:
  CacheDesc cache_;
  std::string key_;
  std::vector<std::byte> bytes_;
};

}  // namespace tyndall::tables
