#include "pictures.hpp"

#include <string>

#include "gpu/try.hpp"
#include "viewer_shaders.hpp"

namespace tyndall::viewer {
namespace {

struct Row {
  const char* name;
  const char* meaning;
};
constexpr Row kRows[kShownCount] = {
    {"Picture", "What is seen, tone mapped."},
    {"Radiance", "What is seen, before exposure and tone mapping; times the gain."},
    {"Scene without air", "The ground and the sun's disc before the air is drawn; times the gain."},
    {"Depth", "Distance from the camera, near dark and far bright, logarithmic. Blue: nothing drawn."},
    {"Shadow map", "Depth from the sun in one cascade; the gain stretches the depths about their middle."},
    {"Table: single Rayleigh", "Light scattered once by air. Across: altitude; up: view zenith; slice: sun and azimuth."},
    {"Table: single Mie", "Light scattered once by aerosol. Across: altitude; up: view zenith; slice: sun and azimuth."},
    {"Table: higher orders", "Light scattered more than once. Across: altitude; up: view zenith; slice: sun and azimuth."},
    {"Table: sunlight", "What the air leaves of the sun's light. Across: altitude; up: sun zenith."},
    {"Table: light of the sky", "Irradiance from the open sky. Across: altitude; up: sun zenith."},
};

}  // namespace

const char* name_of(Shown shown) { return kRows[static_cast<int>(shown)].name; }
const char* meaning_of(Shown shown) { return kRows[static_cast<int>(shown)].meaning; }

Result<void> Pictures::create(const gpu::Device& device, VkFormat format) {
  device_ = &device;
  const auto make = [&](gpu::Pipeline& out, const char* name, const gpu::Shader& fragment) -> Result<void> {
    gpu::GraphicsDesc desc;
    desc.name = name;
    desc.vertex = &shaders::present_vert;
    desc.fragment = &fragment;
    desc.color_format = format;
    TYNDALL_ASSIGN(out, gpu::create_graphics_pipeline(device, desc));
    return {};
  };
  TYNDALL_TRY(make(picture_, "present_picture", shaders::present_picture_frag));
  TYNDALL_TRY(make(depth_, "present_depth", shaders::present_depth_frag));
  TYNDALL_TRY(make(layer_, "present_layer", shaders::present_layer_frag));
  TYNDALL_TRY(make(table_, "present_table", shaders::present_table_frag));
  TYNDALL_ASSIGN(nearest_, gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST}));
  // Not every device filters 32-bit floats.
  VkFormatProperties properties = {};
  device.vk.GetPhysicalDeviceFormatProperties(device.physical_device, VK_FORMAT_R32G32B32A32_SFLOAT, &properties);
  const bool filters = (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
  TYNDALL_ASSIGN(linear_, gpu::create_sampler(device, {.filter = filters ? VK_FILTER_LINEAR : VK_FILTER_NEAREST}));
  return {};
}

Result<void> Pictures::draw(VkCommandBuffer cmd, const gpu::Pipeline& pipeline,
                            std::span<const gpu::NamedResource> resources, const void* push) {
  const gpu::Label label(*device_, cmd, pipeline.name);
  const std::string_view missing = gpu::bind(*device_, cmd, pipeline, resources, push);
  if (!missing.empty()) return Error{ErrorCode::invalid_argument, "nothing is bound to " + std::string(missing)};
  device_->vk.CmdDraw(cmd, 3, 1, 0, 0);
  return {};
}

Result<void> Pictures::record(VkCommandBuffer cmd, VkExtent2D window, scene::Scene& scene, scene::Scene* other,
                              const PictureOptions& options) {
  const scene::Scene::Images images = scene.images();
  constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
  constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  const float aspect = static_cast<float>(window.width) / static_cast<float>(window.height);
  const auto show_color = [&](const gpu::Image& left, const gpu::Image& right, VkImageLayout layout, float gain) {
    const struct {
      float divider, line_width, gain;
      std::uint32_t difference;
    } push = {other != nullptr ? options.divider : 1.0F, 1.0F / static_cast<float>(window.width),
              options.difference && other != nullptr ? options.gain : gain, options.difference ? 1U : 0U};
    const gpu::NamedResource resources[] = {gpu::named_image("left_picture", left.view.get(), layout, linear_.get()),
                                            gpu::named_image("right_picture", right.view.get(), layout, linear_.get())};
    return draw(cmd, picture_, resources, &push);
  };
  const auto show_table = [&](VkImageView view, float slice) {
    const struct {
      float slice, gain;
    } push = {slice, options.gain};
    const gpu::NamedResource resources[] = {gpu::named_image("table", view, kGeneral, nearest_.get())};
    return draw(cmd, table_, resources, &push);
  };
  const auto show_flat = [&](VkImageView view) {
    const struct {
      float divider, line_width, gain;
      std::uint32_t difference;
    } push = {1.0F, 0.0F, options.gain, 0};
    const gpu::NamedResource resources[] = {gpu::named_image("left_picture", view, kGeneral, linear_.get()),
                                            gpu::named_image("right_picture", view, kGeneral, linear_.get())};
    return draw(cmd, picture_, resources, &push);
  };
  const scene::Scene::Images others = other != nullptr ? other->images() : images;
  switch (options.shown) {
    case Shown::picture: return show_color(images.display, others.display, kGeneral, 1.0F);
    case Shown::radiance: return show_color(images.output, others.output, kGeneral, options.gain);
    case Shown::color: return show_color(images.color, others.color, kRead, options.gain);
    case Shown::depth: {
      const struct {
        float near_m, nearest_m, farthest_m;
      } push = {static_cast<float>(scene::kNearPlane_m), 1.0F, 1.0e6F};
      const gpu::NamedResource resources[] = {
          gpu::named_image("depth_picture", images.depth.view.get(), kRead, nearest_.get())};
      return draw(cmd, depth_, resources, &push);
    }
    case Shown::shadow_map: {
      const struct {
        float aspect, layer, gain;
      } push = {aspect, static_cast<float>(options.layer), options.gain};
      const gpu::NamedResource resources[] = {
          gpu::named_image("layers", images.shadow_maps.view.get(), kRead, nearest_.get())};
      return draw(cmd, layer_, resources, &push);
    }
    case Shown::single_rayleigh: return show_table(scene.effect().scattering_tables().single_rayleigh.view, options.slice);
    case Shown::single_mie: return show_table(scene.effect().scattering_tables().single_mie.view, options.slice);
    case Shown::high_orders: return show_table(scene.effect().scattering_tables().high_orders.view, options.slice);
    case Shown::sun_transmittance: return show_flat(scene.effect().light_tables().sun_transmittance);
    case Shown::sky_irradiance: return show_flat(scene.effect().light_tables().sky_irradiance);
  }
  return {};
}

}  // namespace tyndall::viewer
