// Measures the durations of the passes of a command buffer with GPU timestamps.
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

// Each command buffer in flight has a slot. The results of a slot can be read once its command buffer has completed.
// Recording allocates nothing.
class Timer {
 public:
  // `slots`: number of command buffers in flight; `scopes`: maximum number of timed passes in one of them.
  static Result<Timer> create(const Device& device, std::uint32_t slots, std::uint32_t scopes);

  void begin_frame(VkCommandBuffer cmd, std::uint32_t slot);
  // Passes beyond `scopes` are not timed.
  void begin(VkCommandBuffer cmd, const char* name);
  void end(VkCommandBuffer cmd);

  // Returns the durations in the last command buffer of the slot, in the order of recording. Valid until the next call.
  std::span<const TimedScope> read(std::uint32_t slot);

 private:
  const Device* device_ = nullptr;
  Handle<VkQueryPool> pool_;
  std::uint32_t scopes_ = 0;
  std::uint32_t slot_ = 0;
  bool open_ = false;  // between begin() and end() of a timed pass
  std::vector<std::vector<const char*>> names_;
  std::vector<TimedScope> results_;
  std::vector<std::uint64_t> ticks_;
};

}  // namespace tyndall::gpu
