// Measures the durations of the passes of a command buffer with GPU timestamps.
//
// On CPU devices a full barrier precedes and follows every timestamp, because some of them execute a timestamp only at
// the next barrier. On GPUs, timestamps have no barriers of their own, so that measuring does not change what it
// measures: passes that do not depend on each other may overlap, and the time of a pass is that between the ends of the
// passes before it and of the pass itself.
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
  // Begin and end a scope that contains all passes in between; read() returns it in addition to the scopes of the
  // passes. On CPU devices they do nothing, because the barriers around the passes would be measured too.
  void begin_whole(VkCommandBuffer cmd, const char* name);
  void end_whole(VkCommandBuffer cmd);
  // Passes beyond `scopes` are not timed.
  void begin(VkCommandBuffer cmd, const char* name);
  void end(VkCommandBuffer cmd);

  // Returns the durations in the last command buffer of the slot, in the order in which scopes began. Valid until the
  // next call.
  std::span<const TimedScope> read(std::uint32_t slot);

 private:
  // Writes the first (0) or second (1) timestamp of a scope.
  void write(VkCommandBuffer cmd, std::size_t scope, std::uint32_t which);

  const Device* device_ = nullptr;
  Handle<VkQueryPool> pool_;
  std::uint32_t scopes_ = 0;
  std::uint32_t slot_ = 0;
  bool settles_ = true;    // barriers around timestamps
  bool open_ = false;      // between begin() and end() of a timed pass
  std::size_t whole_ = 0;  // index of the scope of begin_whole(), plus one; 0: none
  std::vector<std::vector<const char*>> names_;
  std::vector<TimedScope> results_;
  std::vector<std::uint64_t> ticks_;
};

}  // namespace tyndall::gpu
