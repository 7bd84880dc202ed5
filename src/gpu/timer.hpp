// GPU timestamps by pass name, for the passes of one command buffer at a time and slot.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/device.hpp"

namespace tyndall::gpu {

struct TimedScope {
  const char* name;
  double milliseconds;
};

// Results of a slot may be read once its command buffer has completed. Recording allocates nothing.
class Timer {
 public:
  // `slots`: command buffers in flight; `scopes`: the most passes that one records.
  static Result<Timer> create(const Device& device, std::uint32_t slots, std::uint32_t scopes);

  void begin_frame(VkCommandBuffer cmd, std::uint32_t slot);
  // Passes beyond `scopes` are not timed.
  void begin(VkCommandBuffer cmd, const char* name);
  void end(VkCommandBuffer cmd);

  // Times of the slot's last command buffer, in the order recorded; valid until the next call.
  std::span<const TimedScope> read(std::uint32_t slot);

 private:
  const Device* device_ = nullptr;
  Handle<VkQueryPool> pool_;
  std::uint32_t scopes_ = 0;
  std::uint32_t slot_ = 0;
  bool open_ = false;  // between begin and end of a pass that is timed
  std::vector<std::vector<const char*>> names_;
  std::vector<TimedScope> results_;
  std::vector<std::uint64_t> ticks_;
};

}  // namespace tyndall::gpu
