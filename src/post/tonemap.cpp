#include "post/tonemap.hpp"

#include <string>

#include "gpu/try.hpp"
#include "post_shaders.hpp"

namespace tyndall::post {

Result<Tonemap> Tonemap::create(const gpu::Device& device) {
  Tonemap out;
  out.device_ = &device;
  TYNDALL_ASSIGN(out.pipeline_, gpu::create_compute_pipeline(device, shaders::tonemap_comp));
  out.pipeline_.name = "tonemap";
  return out;
}

Result<void> Tonemap::record(VkCommandBuffer cmd, VkImageView from, VkImageView to, VkExtent2D extent,
                             const TonemapSettings& settings) const {
  const gpu::Label label(*device_, cmd, pipeline_.name);
  const gpu::NamedResource resources[] = {gpu::named_image("radiance", from), gpu::named_image("display", to)};
  const std::string_view missing = gpu::bind(*device_, cmd, pipeline_, resources, &settings);
  if (!missing.empty()) return Error{ErrorCode::invalid_argument, "nothing is bound to " + std::string(missing)};
  gpu::dispatch(*device_, cmd, pipeline_, extent.width, extent.height);
  return {};
}

}  // namespace tyndall::post
