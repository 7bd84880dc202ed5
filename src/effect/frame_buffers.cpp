#include "effect/frame_buffers.hpp"

#include <utility>

#include "gpu/try.hpp"

namespace tyndall {

VkDeviceSize frame_buffer_bytes(const gpu::Device& device, const EffectDesc& desc, const Params& params) {
  VkDeviceSize sum = 0;
  for (const VkDeviceSize size : frame_buffer_sizes(desc, params).bytes) {
    if (size > 0) sum += gpu::buffer_bytes(device, size, kFrameBufferUsage);
  }
  return sum;
}

Result<FrameBuffers::Pending> FrameBuffers::plan(const EffectDesc& desc, const Params& params) {
  Pending pending;
  const FrameBufferSizes sizes = frame_buffer_sizes(desc, params);
  for (std::size_t i = 0; i < kFrameBuffers; ++i) {
    pending.replaced[i] = sizes.bytes[i] != buffers_[i].size;
    if (sizes.bytes[i] == 0 || !pending.replaced[i]) continue;
    TYNDALL_ASSIGN(pending.buffers[i], gpu::create_buffer(*device_, name_of(frame_buffer(i)), sizes.bytes[i],
                                                          kFrameBufferUsage, gpu::MemoryKind::device));
  }
  retired_.reserve(retired_.size() + kFrameBuffers);  // commit() must not allocate
  return pending;
}

void FrameBuffers::commit(Pending&& pending, std::uint32_t frames) noexcept {
  for (std::size_t i = 0; i < kFrameBuffers; ++i) {
    if (!pending.replaced[i]) continue;
    if (buffers_[i].size > 0) retired_.push_back({std::move(buffers_[i]), frames});
    buffers_[i] = std::move(pending.buffers[i]);
  }
}

void FrameBuffers::begin_frame() {
  for (Retired& r : retired_) --r.frames_left;
  std::erase_if(retired_, [](const Retired& r) { return r.frames_left == 0; });
}

VkDeviceSize FrameBuffers::bytes() const {
  VkDeviceSize sum = 0;
  for (const gpu::Buffer& buffer : buffers_) sum += buffer.bytes;
  return sum;
}

VkDeviceSize FrameBuffers::retired_bytes() const {
  VkDeviceSize sum = 0;
  for (const Retired& r : retired_) sum += r.buffer.bytes;
  return sum;
}

}  // namespace tyndall
