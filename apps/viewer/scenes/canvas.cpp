#include "viewer/scenes/canvas.hpp"

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
    {"Picture", "The final picture, tone mapped."},
    {"Radiance", "The radiance before exposure and tone mapping, times the gain."},
    {"Scene without atmosphere", "The terrain and the sun's disc before the atmosphere is applied, times the gain."},
    {"Depth", "Distance from the camera on a logarithmic scale, dark where it is small. Blue where nothing was drawn."},
    {"Shadow map", "Depth in one shadow cascade. The gain increases the contrast around the mean depth."},
    {"Table: single Rayleigh",
     "Light scattered once by air molecules. Horizontal: altitude. Vertical: view zenith. Slice: sun and azimuth."},
    {"Table: single Mie",
     "Light scattered once by aerosol. Horizontal: altitude. Vertical: view zenith. Slice: sun and azimuth."},
    {"Table: higher orders",
     "Light scattered more than once. Horizontal: altitude. Vertical: view zenith. Slice: sun and azimuth."},
    {"Table: sun transmittance", "Transmittance towards the sun. Horizontal: altitude. Vertical: sun zenith."},
    {"Table: sky irradiance",
     "Irradiance of the open sky on a horizontal surface. Horizontal: altitude. Vertical: sun zenith."},
};

}  // namespace

const char* name_of(Shown shown) { return kRows[static_cast<int>(shown)].name; }
const char* meaning_of(Shown shown) { return kRows[static_cast<int>(shown)].meaning; }

bool same_view(const View& a, const View& b) {
  return a.shown == b.shown && a.precise == b.precise && a.layer == b.layer && a.slice == b.slice &&
         a.stretch == b.stretch && a.extent.width == b.extent.width && a.extent.height == b.extent.height;
}

Result<gpu::Handle<VkSampler>> create_float_sampler(const gpu::Device& device) {
  VkFormatProperties properties = {};
  device.vk.GetPhysicalDeviceFormatProperties(device.physical_device, VK_FORMAT_R32G32B32A32_SFLOAT, &properties);
  const bool filters = (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
  return gpu::create_sampler(device, {.filter = filters ? VK_FILTER_LINEAR : VK_FILTER_NEAREST});
}

Canvas::~Canvas() {
  if (host_ != nullptr) static_cast<void>(host_->wait(submission_));
}

Result<void> Canvas::create(gpu::Host& host, bool to_host, bool ahead) {
  host_ = &host;
  to_host_ = to_host;
  ahead_ = ahead && !to_host;
  const gpu::Device& device = host.device();
  const auto make = [&](gpu::Pipeline& out, const char* name, const gpu::Shader& fragment,
                        bool precise = false) -> Result<void> {
    gpu::GraphicsDesc desc;
    desc.name = name;
    desc.vertex = &shaders::present_vert;
    desc.fragment = &fragment;
    desc.color_format = format_of({.precise = precise});
    TYNDALL_ASSIGN(out, gpu::create_graphics_pipeline(device, desc));
    return {};
  };
  TYNDALL_TRY(make(color_, "show_color", shaders::show_color_frag));
  TYNDALL_TRY(make(precise_color_, "show_color", shaders::show_color_frag, true));
  TYNDALL_TRY(make(depth_, "show_depth", shaders::show_depth_frag));
  TYNDALL_TRY(make(layer_, "show_layer", shaders::show_layer_frag));
  TYNDALL_TRY(make(precise_table_, "show_table", shaders::show_table_frag, true));
  TYNDALL_ASSIGN(nearest_, gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST}));
  TYNDALL_ASSIGN(linear_, create_float_sampler(device));
  return {};
}

Result<Picture> Canvas::draw(scene::Scene& scene, const View& view) {
  const gpu::Device& device = host_->device();
  if (image_ == nullptr || image_->desc.format != format_of(view) || image_->desc.extent.width != view.extent.width ||
      image_->desc.extent.height != view.extent.height) {
    TYNDALL_ASSIGN(gpu::Image image,
                   gpu::create_image(device, {"canvas",
                                              format_of(view),
                                              {view.extent.width, view.extent.height, 1},
                                              VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                                  VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
    TYNDALL_TRY(host_->wait(submission_));
    image_ = std::make_shared<gpu::Image>(std::move(image));
  }
  const gpu::Host::Record commands = [&](VkCommandBuffer cmd) -> Result<void> {
    gpu::transition(device, cmd, *image_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    VkRenderingAttachmentInfo color = {};
    color.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    color.imageView = image_->view.get();
    color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo rendering = {};
    rendering.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    rendering.renderArea = {{0, 0}, view.extent};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &color;
    device.vk.CmdBeginRendering(cmd, &rendering);
    const VkViewport viewport = {0, 0, static_cast<float>(view.extent.width), static_cast<float>(view.extent.height),
                                 0, 1};
    const VkRect2D scissor = {{0, 0}, view.extent};
    device.vk.CmdSetViewport(cmd, 0, 1, &viewport);
    device.vk.CmdSetScissor(cmd, 0, 1, &scissor);
    Result<void> recorded = record(cmd, scene, view);
    device.vk.CmdEndRendering(cmd);
    gpu::transition(device, cmd, *image_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    return recorded;
  };
  if (ahead_) {
    TYNDALL_ASSIGN(submission_, host_->submit(commands));
  } else {
    TYNDALL_TRY(host_->run(commands));
  }
  Picture out;
  out.extent = view.extent;
  out.format = format_of(view);
  if (!to_host_) {
    out.image = image_;
    return out;
  }
  TYNDALL_ASSIGN(out.texels,
                 gpu::download(*host_, *image_, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, 0, view.precise ? 16 : 8));
  return out;
}

Result<void> Canvas::draw(VkCommandBuffer cmd, const gpu::Pipeline& pipeline, const gpu::NamedResource& resource,
                          const void* push) {
  const gpu::Device& device = host_->device();
  const gpu::Label label(device, cmd, pipeline.name);
  TYNDALL_TRY(gpu::bind(host_->sets(), cmd, pipeline, {&resource, 1}, push));
  device.vk.CmdDraw(cmd, 3, 1, 0, 0);
  return {};
}

Result<void> Canvas::record(VkCommandBuffer cmd, scene::Scene& scene, const View& view) {
  const scene::Scene::Images images = scene.images();
  constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
  constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  const auto show = [&](VkImageView image, VkImageLayout layout) {
    return draw(cmd, view.precise ? precise_color_ : color_, gpu::named_image("image", image, layout, linear_.get()));
  };
  const auto show_table = [&](VkImageView table) {
    return draw(cmd, precise_table_, gpu::named_image("table", table, kGeneral, nearest_.get()), &view.slice);
  };
  switch (view.shown) {
    case Shown::picture: return show(images.display.view.get(), kGeneral);
    case Shown::radiance: return show(images.output.view.get(), kGeneral);
    case Shown::color: return show(images.color.view.get(), kRead);
    case Shown::depth: {
      const struct {
        float near_m, nearest_m, farthest_m;
      } push = {static_cast<float>(scene::kNearPlane_m), 1.0F, 1.0e6F};
      return draw(cmd, depth_, gpu::named_image("depth_picture", images.depth.view.get(), kRead, nearest_.get()),
                  &push);
    }
    case Shown::shadow_map: {
      const auto last = static_cast<int>(images.shadow_maps.desc.layers) - 1;
      const struct {
        float aspect, layer, gain;
      } push = {static_cast<float>(view.extent.width) / static_cast<float>(view.extent.height),
                static_cast<float>(view.layer < last ? view.layer : last), view.stretch};
      return draw(cmd, layer_, gpu::named_image("layers", images.shadow_maps.view.get(), kRead, nearest_.get()), &push);
    }
    case Shown::single_rayleigh: return show_table(scene.effect().scattering_tables().single_rayleigh.view);
    case Shown::single_mie: return show_table(scene.effect().scattering_tables().single_mie.view);
    case Shown::high_orders: return show_table(scene.effect().scattering_tables().high_orders.view);
    case Shown::sun_transmittance: return show(scene.effect().light_tables().sun_transmittance, kGeneral);
    case Shown::sky_irradiance: return show(scene.effect().light_tables().sky_irradiance, kGeneral);
  }
  return {};
}

}  // namespace tyndall::viewer
