// Draws the picture of a scene, or one of its intermediate images and tables, into a canvas of the window's size. Runs
// on the device and the thread of the scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gpu/descriptors.hpp"
#include "gpu/host.hpp"
#include "gpu/resource.hpp"
#include "scene/scene.hpp"

namespace tyndall::viewer {

enum class Shown : int {
  picture,
  radiance,
  color,
  depth,
  shadow_map,
  single_rayleigh,
  single_mie,
  high_orders,
  sun_transmittance,
  sky_irradiance
};
constexpr int kShownCount = 10;
[[nodiscard]] const char* name_of(Shown shown);
[[nodiscard]] const char* meaning_of(Shown shown);

// The inputs of a canvas besides the scene.
struct View {
  Shown shown = Shown::picture;
  int layer = 0;         // layer of the shadow maps to show
  float slice = 0.5F;    // position of the slice through a table, 0 to 1
  float stretch = 1.0F;  // contrast of a shadow map's depths
  bool precise = false;  // the window multiplies the canvas by a gain, so half precision would show; not with depths
  VkExtent2D extent = {0, 0};
};
[[nodiscard]] bool same_view(const View& a, const View& b);

// Values from 0 to 1 in half precision are finer than the 8 bits of the window.
[[nodiscard]] constexpr VkFormat format_of(const View& view) {
  return view.precise ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT;
}

// A finished canvas: linear values from 0 to 1, or radiance. It is an image on the window's device, or texels to be
// uploaded there.
struct Picture {
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkExtent2D extent = {0, 0};
  std::shared_ptr<const gpu::Image> image;  // in SHADER_READ_ONLY_OPTIMAL
  std::vector<std::byte> texels;
};

class Canvas {
 public:
  Canvas() = default;
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;
  ~Canvas();
  // Creates the pipelines. `to_host`: return canvases as texels. `ahead`: draw() returns before the canvas is complete,
  // unless it returns texels; later commands of the same queue see it complete.
  Result<void> create(gpu::Host& host, bool to_host, bool ahead);
  Result<Picture> draw(scene::Scene& scene, const View& view);

 private:
  Result<void> record(VkCommandBuffer cmd, scene::Scene& scene, const View& view);
  Result<void> draw(VkCommandBuffer cmd, const gpu::Pipeline& pipeline, const gpu::NamedResource& resource,
                    const void* push = nullptr);

  gpu::Host* host_ = nullptr;
  bool to_host_ = false, ahead_ = false;
  std::uint64_t submission_ = 0;  // submission of the last canvas
  std::shared_ptr<gpu::Image> image_;
  gpu::Pipeline color_, precise_color_, depth_, layer_, precise_table_;
  gpu::Handle<VkSampler> nearest_, linear_;
};

// Creates a sampler for RGBA32F, which filters linearly if the device can.
Result<gpu::Handle<VkSampler>> create_float_sampler(const gpu::Device& device);

}  // namespace tyndall::viewer
