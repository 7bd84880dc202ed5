// The buffers of epipolar sampling: allocates them for new settings, and frees them when no frame uses them any more.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "effect/resources.hpp"
#include "gpu/resource.hpp"

namespace tyndall {

// Returns the device memory of the frame buffers with these settings [bytes].
[[nodiscard]] VkDeviceSize frame_buffer_bytes(const gpu::Device& device, const EffectDesc& desc, const Params& params);

class FrameBuffers {
 public:
  // New buffers for those whose size changes with the settings.
  struct Pending {
    std::array<gpu::Buffer, kFrameBuffers> buffers = {};
    std::array<bool, kFrameBuffers> replaced = {};
  };

  void create(const gpu::Device& device) { device_ = &device; }
  // Allocates the buffers for new settings, and changes nothing.
  Result<Pending> plan(const EffectDesc& desc, const Params& params);
  // Replaces buffers by those of the last plan(). The old ones are freed by the `frames`-th following call of
  // begin_frame(), because commands in flight may use them until then.
  void commit(Pending&& pending, std::uint32_t frames) noexcept;
  void begin_frame();

  // Returns a frame buffer, whose handle is null if no step uses it.
  [[nodiscard]] const gpu::Buffer& operator[](Resource resource) const {
    return buffers_[index_of(resource) - kFirstFrameBuffer];
  }
  [[nodiscard]] VkDeviceSize bytes() const;          // memory of the current buffers
  [[nodiscard]] VkDeviceSize retired_bytes() const;  // memory of old buffers that frames in flight may still use

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
