// The slots of the ring of constants: one for each view of each frame in flight, and whether commands may
// still read it.
#pragma once

#include <cstdint>
#include <optional>
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
  // Before a slot is written: an error if the commands of the same frame and view have not completed. Returns
  // the index of another frame whose commands have not, if there is one: they are late, or were never
  // submitted.
  Result<std::optional<std::uint64_t>> take(std::uint64_t frame_index, std::uint32_t view) const;
  // Whether there are commands that have not completed, because they are late or were never submitted.
  [[nodiscard]] bool unfinished() const;
  // Behind the last command that reads the slot.
  void record_end(VkCommandBuffer cmd, std::uint64_t frame_index, std::uint32_t view);

 private:
  struct Slot {
    gpu::Handle<VkEvent> done;  // set by the commands, reset when others are recorded
    std::uint64_t frame_index = 0;
    bool recorded = false;
  };
  [[nodiscard]] bool busy(const Slot& slot) const;

  const gpu::Device* device_ = nullptr;
  std::uint32_t frames_ = 1, views_ = 1;
  std::vector<Slot> slots_;
};

}  // namespace tyndall
