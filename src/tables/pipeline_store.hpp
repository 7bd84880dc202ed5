// Stores the compiled pipelines of a device in the cache on disk, so that drivers need not compile them at each start.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "gpu/host.hpp"
#include "tables/make_ready.hpp"

namespace tyndall::tables {

// From its creation on, the host uses the stored pipelines. The destructor stores those that were added. Both ignore
// errors, because the pipelines can always be compiled. Create it after the host and before everything that
// creates pipelines.
class PipelineStore {
 public:
  PipelineStore(gpu::Host& host, const CacheDesc& cache);
  ~PipelineStore();
  PipelineStore(const PipelineStore&) = delete;
  PipelineStore& operator=(const PipelineStore&) = delete;

  // Returns one line if there was a file that could not be used; otherwise an empty text.
  [[nodiscard]] const std::string& note() const { return note_; }

 private:
  void store();

  gpu::Host& host_;
  CacheDesc desc_;
  std::string key_;
  std::string note_;
  gpu::Handle<VkPipelineCache> cache_;
  std::size_t stored_bytes_ = 0;
};

// Returns whether `data` begins with the header of pipelines that this device has compiled. Drivers check it, too, but
// not all of them do it well.
[[nodiscard]] bool is_of_device(std::span<const std::byte> data, const VkPhysicalDeviceProperties& device);

}  // namespace tyndall::tables
