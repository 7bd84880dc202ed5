// What the window shows under the GUI: the picture, two pictures compared, or one of the images and tables that it
// was made from.
#pragma once

#include "gpu/pipeline.hpp"
#include "gpu/resource.hpp"
#include "scene/scene.hpp"

namespace tyndall::viewer {

enum class Shown : int {
  picture, radiance, color, depth, shadow_map, single_rayleigh, single_mie, high_orders, sun_transmittance, sky_irradiance
};
constexpr int kShownCount = 10;
[[nodiscard]] const char* name_of(Shown shown);
[[nodiscard]] const char* meaning_of(Shown shown);

struct PictureOptions {
  Shown shown = Shown::picture;
  int layer = 0;         // of the shadow maps
  float slice = 0.5F;    // through a table
  float gain = 1.0F;     // of everything but the picture
  bool compare = false;  // with the other scene
  bool difference = false;
  float divider = 0.5F;  // of the window's width
};

class Pictures {
 public:
  Result<void> create(const gpu::Device& device, VkFormat format);
  // Inside a rendering scope over the window. `other` may be null.
  Result<void> record(VkCommandBuffer cmd, VkExtent2D window, scene::Scene& scene, scene::Scene* other,
                      const PictureOptions& options);

 private:
  Result<void> draw(VkCommandBuffer cmd, const gpu::Pipeline& pipeline, std::span<const gpu::NamedResource> resources,
                    const void* push);

  const gpu::Device* device_ = nullptr;
  gpu::Pipeline picture_, depth_, layer_, table_;
  gpu::Handle<VkSampler> linear_, nearest_;
};

}  // namespace tyndall::viewer
