// From linear radiance to displayable values: exposure and a tone-mapping operator, as an effect of its
// own that knows nothing of scattering. Records compute dispatches on a borrowed device.
// Output is linear 0 to 1 in Rec. 709 primaries; encoding as sRGB and dithering belong to the file.
#pragma once

#include "post/exposure.hpp"

namespace tyndall::post {

class Tonemap {
 public:
  static Result<Tonemap> create(const gpu::Device& device, std::uint32_t frames_in_flight = 1);

  // `from` and `to` are RGBA32F in GENERAL layout, of the same extent; barriers are the caller's. With auto exposure,
  // exposure().measure() comes before: an error when it never did.
  Result<void> record(VkCommandBuffer cmd, VkImageView from, VkImageView to, VkExtent2D extent,
                      const TonemapSettings& settings) const;

  [[nodiscard]] Exposure& exposure() { return exposure_; }
  [[nodiscard]] const Exposure& exposure() const { return exposure_; }

 private:
  const gpu::Device* device_ = nullptr;
  std::array<gpu::Pipeline, kOperators> pipelines_;
  Exposure exposure_;
};

}  // namespace tyndall::post
