// Exposure and tone mapping: converts linear radiance to displayable values. An effect of its own, independent of
// scattering, which records compute dispatches on a borrowed device. The output is linear [0; 1] in Rec. 709 primaries;
// sRGB encoding and dithering happen when a file is written.
#pragma once

#include "post/exposure.hpp"

namespace tyndall::post {

class Tonemap {
 public:
  static Result<Tonemap> create(const gpu::Device& device, std::uint32_t frames_in_flight = 1);

  // Records the pass. `from` and `to` are RGBA32F in GENERAL layout and of the same extent; barriers are up to the
  // caller. With auto exposure, exposure().measure() must have been recorded before, else this fails. `slot` is below
  // frames_in_flight; the commands that were recorded with it before must have completed.
  Result<void> record(VkCommandBuffer cmd, VkImageView from, VkImageView to, VkExtent2D extent,
                      const TonemapSettings& settings, std::uint32_t slot = 0) const;

  [[nodiscard]] Exposure& exposure() { return exposure_; }
  [[nodiscard]] const Exposure& exposure() const { return exposure_; }

 private:
  const gpu::Device* device_ = nullptr;
  std::array<gpu::Pipeline, kOperators> pipelines_;  // one for each operator; all have the same bindings
  gpu::DescriptorSets sets_;                         // one set for each slot
  std::uint32_t slots_ = 0;
  Exposure exposure_;
};

}  // namespace tyndall::post
