// From linear radiance to displayable values: exposure and a tone-mapping operator, as an effect of its
// own that knows nothing of scattering. Records compute dispatches on a borrowed device.
// Output is linear 0 to 1 in Rec. 709 primaries; encoding as sRGB and dithering belong to the file.
#pragma once

#include "gpu/pipeline.hpp"
#include "gpu/resource.hpp"

namespace tyndall::post {

// Values of TonemapOperator in src/scene/scene_params.def.
enum class Operator : std::uint32_t { exponential, uncharted2 };

struct TonemapSettings {
  Operator op = Operator::uncharted2;
  float exposure = 1.8F;     // scales the radiance
  float white_point = 3.0F;  // scaled value that becomes white (Uncharted 2)
};

class Tonemap {
 public:
  static Result<Tonemap> create(const gpu::Device& device);

  // `from` and `to` are RGBA32F in GENERAL layout, of the same extent; barriers are the caller's.
  Result<void> record(VkCommandBuffer cmd, VkImageView from, VkImageView to, VkExtent2D extent,
                      const TonemapSettings& settings) const;

 private:
  const gpu::Device* device_ = nullptr;
  gpu::Pipeline pipeline_;
};

}  // namespace tyndall::post
