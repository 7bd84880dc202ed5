// The buffers of epipolar sampling: their allocation for other settings, and their release when no frame uses them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "effect/resources.hpp"
#include "gpu/resource.hpp"

namespace tyndall {

// Device memory that the frame buffers take with these settings.
[[nodiscard]] VkDeviceSize frame_buffer_bytes(const gpu::Device& device, const EffectDesc& desc, const Params& params);

class FrameBuffers {
 public:
  // Buffers for other settings, in place of those whose size changes.
  struct Pending {
    std::array<gpu::Buffer, kFrameBuffers> buffers = {};
    std::array<bool, kFrameBuffers> replaced = {};
  };

  void create(const gpu::Device& device) { device_ = &device; }
  // Allocates what other settings need and changes nothing.
  Result<Pending> plan(const EffectDesc& desc, const Params& params);
  // Takes over what was planned last. The buffers that it replaces are freed by the `frames`-th call of begin_frame()
  // from now on, because commands in flight may use them.
  void commit(Pending&& pending, std::uint32_t frames) noexcept;
  void begin_frame();

  // Null where no step uses the buffer. Only for frame buffers.
  [[nodiscard]] const gpu::Buffer& operator[](Resource resource) const {
    return buffers_[index_of(resource) - kFirstFrameBuffer];
  }
  [[nodiscard]] VkDeviceSize bytes() const;          // in use
  [[nodiscard]] VkDeviceSize retired_bytes() const;  // waiting for frames in flight

 private:
  struct Retired {
    gpu::Buffer buffer;
    std::uint32_t frames_left;
  };

  const gpu::Device* device_ = nullptr;
  std::array<gpu::Buffer, kFrameBuffers> buffers_ = {};
  std::vector<Retired> retired_ = {};
};

}  // namespace tyndall
