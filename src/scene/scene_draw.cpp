// Records the passes of a frame: the shadow maps, the shadow colours, the view, and the effect.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "gpu/try.hpp"
#include "math/angles.hpp"
#include "scene/description/placed_sun.hpp"
#include "scene/formats.hpp"
#include "scene/scene.hpp"
#include "scene/sky/background_constants.hpp"
#include "scene/sky/sun_disc.hpp"
#include "tyndall/photometry.hpp"

namespace tyndall::scene {
namespace {

VkRenderingAttachmentInfo attachment(VkImageView view, VkImageLayout layout, VkAttachmentLoadOp load,
                                     VkClearValue clear) {
  VkRenderingAttachmentInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  info.imageView = view;
  info.imageLayout = layout;
  info.loadOp = load;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  info.clearValue = clear;
  return info;
}

void begin_rendering(const gpu::Device& device, VkCommandBuffer cmd, VkExtent2D extent,
                     std::span<const VkRenderingAttachmentInfo> colors, const VkRenderingAttachmentInfo* depth) {
  VkRenderingInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  info.renderArea = {{0, 0}, extent};
  info.layerCount = 1;
  info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  info.pColorAttachments = colors.data();
  info.pDepthAttachment = depth;
  device.vk.CmdBeginRendering(cmd, &info);
  const VkViewport viewport = {0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
  const VkRect2D scissor = {{0, 0}, extent};
  device.vk.CmdSetViewport(cmd, 0, 1, &viewport);
  device.vk.CmdSetScissor(cmd, 0, 1, &scissor);
}

// Returns the constants of background.frag: the sun's disc with its colour above the atmosphere, the moon, and the
// conversion of pixels to directions.
BackgroundConstants background_constants(const ModelFrame& frame, const glm::dvec3& to_sun, const Vec3& color,
                                         const MoonParams& placed) {
  const View& view = frame.view;
  const double radius_rad = frame.scene.sun.angular_radius_deg * kRadPerDeg;
  const double solid_angle = 6.283185307179586 * (1.0 - std::cos(radius_rad));
  const Vec3& given = frame.scene.sun.irradiance;
  const float scale = frame.params.scattering.scale;
  const Vec3 irradiance = {given.x * scale, given.y * scale, given.z * scale};
  const Vec3 sun = {irradiance.x * color.x, irradiance.y * color.y, irradiance.z * color.z};
  BackgroundConstants out = {};
  out.local_from_view = camera_from_view(view, frame.local.local_from_world).world_from_view;
  out.world_from_local = to_mat4(frame.local.world_from_local);
  out.direction_to_sun = to_vec3(frame.local.direction(to_sun));
  out.angular_radius_rad = static_cast<float>(radius_rad);
  out.disc_radiance = to_vec3(glm::dvec3(sun.x, sun.y, sun.z) / solid_angle);
  out.pixel_angle_rad = static_cast<float>(2.0 * view.tan_half_height / frame.extent.height);
  const double glow = frame.scene.night.airglow / kSunIlluminance_lux;
  out.airglow = to_vec3(glow * glm::dvec3(sun.x, sun.y, sun.z));
  const Vec3& nm = frame.params.atmosphere.wavelengths_nm;
  out.limb_exponent = {limb_exponent(nm.x), limb_exponent(nm.y), limb_exponent(nm.z)};
  out.tan_half[0] = static_cast<float>(view.tan_half_width);
  out.tan_half[1] = static_cast<float>(view.tan_half_height);
  out.jitter[0] = static_cast<float>(view.jitter.x);
  out.jitter[1] = static_cast<float>(view.jitter.y);
  if (frame.scene.sun.refraction) {
    const double seen_deg = std::asin(std::clamp(to_sun.y, -1.0, 1.0)) / kRadPerDeg;
    out.sun_stretch =
        static_cast<float>(1.0 / refraction_flattening(seen_deg, frame.scene.sun.angular_radius_deg) - 1.0);
    out.up = to_vec3(frame.local.direction({0.0, 1.0, 0.0}));
  }
  if (frame.scene.moon.visible) {
    SunParams moon;
    moon.elevation_deg = placed.elevation_deg;
    moon.azimuth_deg = placed.azimuth_deg;
    out.direction_to_moon = to_vec3(frame.local.direction(direction_to_sun(moon)));
    out.moon_radius_rad = static_cast<float>(placed.angular_radius_deg * kRadPerDeg);
    out.moon_irradiance = sun;
  }
  return out;
}

}  // namespace

Result<void> Scene::draw_shadows(VkCommandBuffer cmd) {
  const gpu::Device& device = host_->device();
  const std::uint32_t resolution = scene_.shadows.resolution;
  gpu::transition(device, cmd, shadow_maps_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
  begin_pass(cmd, "shadow_maps");
  for (std::uint32_t i = 0; i < cascades_.size(); ++i) {
    const gpu::Label label(device, cmd, "shadow_maps");
    VkClearValue clear = {};
    clear.depthStencil = {1.0F, 0};
    const VkRenderingAttachmentInfo depth = attachment(
        shadow_layers_[i].get(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR, clear);
    begin_rendering(device, cmd, {resolution, resolution}, {}, &depth);
    TYNDALL_TRY(terrain_->draw_cascade(cmd, cascades_[i], i));
    if (meshes_ != nullptr) TYNDALL_TRY(meshes_->draw_cascade(cmd, cascades_[i]));
    device.vk.CmdEndRendering(cmd);
  }
  end_pass(cmd);
  gpu::transition(device, cmd, shadow_maps_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  return draw_shadow_colors(cmd);
}

// Records the maps of shadow colours, one cascade after the other.
Result<void> Scene::draw_shadow_colors(VkCommandBuffer cmd) {
  if (meshes_ == nullptr || !meshes_->has_glass()) return {};
  const gpu::Device& device = host_->device();
  const std::uint32_t resolution = scene_.shadows.resolution;
  gpu::transition(device, cmd, shadow_colors_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  begin_pass(cmd, "shadow_colors");
  for (std::uint32_t i = 0; i < cascades_.size(); ++i) {
    VkClearValue clear = {};
    clear.color = {{1.0F, 1.0F, 1.0F, 1.0F}};
    const VkRenderingAttachmentInfo color = attachment(
        shadow_color_layers_[i].get(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR, clear);
    begin_rendering(device, cmd, {resolution, resolution}, {&color, 1}, nullptr);
    TYNDALL_TRY(meshes_->draw_colors(cmd, cascades_[i]));
    device.vk.CmdEndRendering(cmd);
  }
  end_pass(cmd);
  gpu::transition(device, cmd, shadow_colors_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  return {};
}

Result<void> Scene::draw_view(VkCommandBuffer cmd) {
  const gpu::Device& device = host_->device();
  const ModelFrame frame = {view_, frame_, light_, params_, scene_, desc_.extent};
  // While tables of the other scattering.color are being built, the light of the scene is that of the old ones.
  const Vec3 color = sun_color(model_ == nullptr ? table_params(*effect_) : params_);
  background_constants_.write(background_constants(frame, to_sun_, color, moon_));

  gpu::transition(device, cmd, color_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  gpu::transition(device, cmd, depth_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
  std::vector<VkRenderingAttachmentInfo> colors = {
      attachment(color_.view.get(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_CLEAR, {})};
  std::span<const gpu::Image> air, air_drawn;
  if (model_ != nullptr) {
    air = model_->air();
    air_drawn = model_->attachments();
    for (const gpu::Image& image : air_drawn) {
      gpu::transition(device, cmd, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
      // The images need not be cleared, because only texels where ground has been drawn are read.
      colors.push_back(
          attachment(image.view.get(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_DONT_CARE, {}));
    }
  }
  const VkRenderingAttachmentInfo depth = attachment(depth_.view.get(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                                     VK_ATTACHMENT_LOAD_OP_CLEAR, {});  // reversed: 0 is far
  const VkRenderingAttachmentInfo on_color =
      attachment(color_.view.get(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD, {});
  const VkRenderingAttachmentInfo on_depth =
      attachment(depth_.view.get(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_ATTACHMENT_LOAD_OP_LOAD, {});
  // Timestamps are written between rendering scopes, because their barriers are not allowed inside one.
  begin_pass(cmd, "terrain");
  begin_rendering(device, cmd, desc_.extent, colors, &depth);
  if (model_ != nullptr) {
    TYNDALL_TRY(model_->draw_ground(cmd, *terrain_, frame));
  } else {
    TYNDALL_TRY(terrain_->draw_view(cmd, view_));
  }
  device.vk.CmdEndRendering(cmd);
  end_pass(cmd);
  gpu::transition(device, cmd, color_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
  const VkImageLayout air_layout =
      air_drawn.empty() ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  for (const gpu::Image& image : air) gpu::transition(device, cmd, image, air_layout, VK_IMAGE_LAYOUT_GENERAL);
  begin_pass(cmd, "terrain_light");
  if (model_ != nullptr) {
    TYNDALL_TRY(model_->light_ground(cmd, *terrain_, frame, color_.view.get()));
  } else {
    TYNDALL_TRY(terrain_->light_view(cmd, light_, color_.view.get(), desc_.extent));
  }
  end_pass(cmd);
  gpu::transition(device, cmd, color_, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
               VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
               VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                   VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT,
               VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                   VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT);
  begin_pass(cmd, model_ != nullptr ? "sky" : "background");
  begin_rendering(device, cmd, desc_.extent, {&on_color, 1}, &on_depth);
  if (model_ != nullptr) {
    TYNDALL_TRY(model_->draw_sky(cmd, background_constants_.buffer()));
  } else {
    if (meshes_ != nullptr) TYNDALL_TRY(meshes_->draw_view(cmd, view_, light_));
    const gpu::Label label(device, cmd, background_.name);
    const gpu::NamedResource resources[] = {gpu::named_buffer("background_block", background_constants_.buffer())};
    TYNDALL_TRY(gpu::bind(host_->sets(), cmd, background_, resources));
    device.vk.CmdDraw(cmd, 3, 1, 0, 0);
    if (meshes_ != nullptr) TYNDALL_TRY(meshes_->draw_clear_glass(cmd, view_, light_));
  }
  device.vk.CmdEndRendering(cmd);
  end_pass(cmd);
  gpu::transition(device, cmd, color_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  gpu::transition(device, cmd, depth_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  return {};
}

Result<void> Scene::run_passes(bool first, bool copy_baseline) {
  const gpu::Device& device = host_->device();
  const bool shadows_are_read = model_ == nullptr || model_->draws_terrain(scene_);
  // The jitter of the samples does not move the cascades, so only the first sample draws them.
  const bool other_shadows = shadows_are_read && first && !(desc_.reuse_shadows && shadows_are_drawn());
  const auto shadows = [&](VkCommandBuffer cmd) -> Result<void> {
    if (desc_.timings) timer_.begin_frame(cmd, slot());
    if (!images_ready_) {
      gpu::transition(device, cmd, output_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
      gpu::transition(device, cmd, display_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    }
    return other_shadows ? draw_shadows(cmd) : Result<void>();
  };
  const auto view = [&](VkCommandBuffer cmd) { return draw_view(cmd); };
  const auto air = [&](VkCommandBuffer cmd) -> Result<void> {
    TYNDALL_TRY(model_ != nullptr ? copy_color(cmd) : run_effect(cmd));
    TYNDALL_TRY(tonemap(cmd, first));
    return copy_baseline ? run_copy_baseline(cmd) : Result<void>();
  };
  const auto whole = [&](VkCommandBuffer cmd) -> Result<void> {
    TYNDALL_TRY(shadows(cmd));
    TYNDALL_TRY(view(cmd));
    return air(cmd);
  };
  // After an error, the contents of shadow maps and the layouts of images are unknown.
  std::vector<CascadeFit> drawn = shadows_are_read ? cascades_ : std::vector<CascadeFit>();
  if (other_shadows) drawn_cascades_.clear();
  if (desc_.in_parts) {
    TYNDALL_TRY(execute(shadows));
    TYNDALL_TRY(execute(view));
    TYNDALL_TRY(execute(air));
  } else {
    TYNDALL_TRY(execute(whole));
  }
  effect_lost_ = false;
  images_ready_ = true;
  drawn_cascades_.swap(drawn);
  drawn_terrain_ = terrain_->version();
  return {};
}

Result<void> Scene::run_effect(VkCommandBuffer cmd) {
  std::array<Cascade, kMaxCascades> cascades;
  for (std::size_t i = 0; i < cascades_.size(); ++i) {
    cascades[i] = {to_mat4(cascades_[i].shadow_from_world() * frame_.world_from_local),
                   static_cast<float>(cascades_[i].near_m), static_cast<float>(cascades_[i].far_m)};
  }
  FrameInputs inputs;
  inputs.extent = desc_.extent;
  inputs.color = {color_.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  inputs.depth = {depth_.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  inputs.shadow_maps = {shadow_maps_.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  if (light_.has_glass && params_.scattering.light_shafts) {
    inputs.shadow_colors = {shadow_colors_.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    inputs.shadow_color_depths = true;
  }
  inputs.shadow_resolution = scene_.shadows.resolution;
  inputs.cascades = {cascades.data(), cascades_.size()};
  inputs.first_marched_cascade = first_marched(scene_.shadows, cascades_);
  inputs.camera = camera_from_view(view_, frame_.local_from_world);
  inputs.sun = {to_vec3(frame_.direction(key_light_.direction)), key_light_.irradiance,
                static_cast<float>(key_light_.angular_radius_deg * kRadPerDeg)};
  inputs.output = {output_.view.get(), VK_IMAGE_LAYOUT_GENERAL};
  inputs.frame_index = frame_index_;
  if (!bare_ground()) inputs.lowest_ground_m = static_cast<float>(std::min(terrain_->ground().min_m, 0.0));
  Result<void> recorded = effect_->record(cmd, inputs);
  effect_lost_ = recorded.ok();  // run_passes() resets it once the commands have been submitted
  return recorded;
}

}  // namespace tyndall::scene
