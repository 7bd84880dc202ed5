// The cube map of a sky probe: its image, and the buffers in which an update computes it.
#pragma once

#include <cstdint>

#include "effect/step_recorder.hpp"
#include "gpu/resource.hpp"
#include "tyndall/sky_probe.hpp"

namespace tyndall {

// Returns an error unless `size` is 0 or a size of cube maps. where: the function that is called.
[[nodiscard]] Result<void> check_cube_size(const char* where, std::uint32_t size);
// Returns the device memory of a cube map [bytes].
[[nodiscard]] VkDeviceSize sky_cube_bytes(const gpu::Device& device, std::uint32_t size);

class SkyCubeMap {
 public:
  // With the size 0, there are no objects, and the other functions do nothing.
  static Result<SkyCubeMap> create(const gpu::Device& device, std::uint32_t size);

  // Sets the buffers in which steps compute the texels.
  void bind(BoundResources& out) const;
  // Records the transition of the image to its layout, and makes it black.
  void record_clear(VkCommandBuffer cmd) const;
  // Records the copy of the computed texels to the image, after earlier commands of the queue that may read it. Makes
  // it visible like a write of a compute shader.
  void record_copy(VkCommandBuffer cmd) const;

  [[nodiscard]] SkyCube cube() const;
  [[nodiscard]] VkDeviceSize bytes() const { return radiance_.bytes + texels_.bytes + image_.bytes; }

 private:
  const gpu::Device* device_ = nullptr;
  gpu::Buffer radiance_, texels_;
  gpu::Image image_;
  gpu::Handle<VkSampler> sampler_;
};

}  // namespace tyndall
