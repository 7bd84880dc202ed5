// The slots of constants and descriptor sets, one per view of a frame in flight. Tracks whether commands may still read
// them.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/device.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

class FrameRing {
 public:
  static Result<FrameRing> create(const gpu::Device& device, const EffectDesc& desc);

  [[nodiscard]] static std::uint32_t slots(const EffectDesc& desc) { return desc.frames_in_flight * desc.views; }
  [[nodiscard]] std::uint32_t slot(std::uint64_t frame_index, std::uint32_t view) const {
    return static_cast<std::uint32_t>(frame_index % frames_) * views_ + view;
  }
  // To be called before a slot is written. Returns an error if the commands that last used the slot have not completed,
  // because they are late or were never submitted.
  Result<void> take(std::uint64_t frame_index, std::uint32_t view) const;
  // Returns whether some commands have not completed, because they are late or were never submitted.
  [[nodiscard]] bool unfinished() const;
  // Marks the commands of a slot as not completed until record_end(), for a frame that is recorded in two parts.
  void hold(std::uint64_t frame_index, std::uint32_t view);
  // Records the event of a slot. To be called after the last command that reads the slot.
  void record_end(VkCommandBuffer cmd, std::uint64_t frame_index, std::uint32_t view);

 private:
  struct Slot {
    gpu::Handle<VkEvent> done;  // set by the commands, reset when the next ones are recorded
    std::uint64_t frame_index = 0;
    bool recorded = false;
  };
  [[nodiscard]] bool busy(const Slot& slot) const;

  const gpu::Device* device_ = nullptr;
  std::uint32_t frames_ = 1, views_ = 1;
  std::vector<Slot> slots_;
};

}  // namespace tyndall
