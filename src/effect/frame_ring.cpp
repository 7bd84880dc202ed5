#include "effect/frame_ring.hpp"

#include <algorithm>
#include <string>

namespace tyndall {

Result<FrameRing> FrameRing::create(const gpu::Device& device, const EffectDesc& desc) {
  FrameRing out;
  out.device_ = &device;
  out.frames_ = desc.frames_in_flight;
  out.views_ = desc.views;
  out.slots_.resize(slots(desc));
  for (Slot& slot : out.slots_) {
    VkEventCreateInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_EVENT_CREATE_INFO;
    VkEvent event = VK_NULL_HANDLE;
    const VkResult made = device.vk.CreateEvent(device.device, &info, device.allocator, &event);
    if (made != VK_SUCCESS) return gpu::vulkan_error(made, "vkCreateEvent", "frame_ring");
    slot.done = gpu::Handle<VkEvent>(device, event);
  }
  return out;
}

// Returns whether the commands of a slot may still run. On a lost device, none do.
bool FrameRing::busy(const Slot& slot) const {
  return slot.recorded && device_->vk.GetEventStatus(device_->device, slot.done.get()) == VK_EVENT_RESET;
}

Result<void> FrameRing::take(std::uint64_t frame_index, std::uint32_t view) const {
  const Slot& s = slots_[slot(frame_index, view)];
  if (!busy(s)) return {};
  if (s.frame_index != frame_index) {
    return Error{ErrorCode::invalid_argument,
                 "FrameInputs::frame_index " + std::to_string(frame_index) +
                     " takes the constants and descriptors of frame " + std::to_string(s.frame_index) +
                     ", whose commands have not completed or were never submitted; expected at most "
                     "EffectDesc::frames_in_flight (" +
                     std::to_string(frames_) + ") frames at a time, and a new Effect after commands were dropped"};
  }
  return Error{ErrorCode::invalid_argument,
               "FrameInputs::frame_index " + std::to_string(frame_index) + " with view " + std::to_string(view) +
                   " was recorded before, and its commands have not completed: both would be drawn with the "
                   "second camera; "
                   "expected the next frame_index, another view below EffectDesc::views (" +
                   std::to_string(views_) + "), or to wait for the first commands"};
}

bool FrameRing::unfinished() const {
  return std::any_of(slots_.begin(), slots_.end(), [this](const Slot& slot) { return busy(slot); });
}

void FrameRing::hold(std::uint64_t frame_index, std::uint32_t view) {
  Slot& s = slots_[slot(frame_index, view)];
  device_->vk.ResetEvent(device_->device, s.done.get());  // no command can still set it: take() refuses busy slots
  s.frame_index = frame_index;
  s.recorded = true;
}

void FrameRing::record_end(VkCommandBuffer cmd, std::uint64_t frame_index, std::uint32_t view) {
  hold(frame_index, view);
  device_->vk.CmdSetEvent(cmd, slots_[slot(frame_index, view)].done.get(),
                          VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT);
}

}  // namespace tyndall
