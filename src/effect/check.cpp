// What can be wrong with what the caller passes, in the caller's terms.
#include <cmath>
#include <string>

#include "effect/frame_constants.hpp"

namespace tyndall {
namespace {

bool finite(const Mat4& m) {
  for (const float entry : m.m) {
    if (!std::isfinite(entry)) return false;
  }
  return true;
}

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Error invalid(std::string message) { return {ErrorCode::invalid_argument, std::move(message)}; }

}  // namespace

Result<void> check_frame(const FrameInputs& inputs, const EffectDesc& desc, const Params& params) {
  const VkExtent2D extent = inputs.extent;
  if (extent.width == 0 || extent.height == 0 || extent.width > desc.max_extent.width ||
      extent.height > desc.max_extent.height) {
    return invalid("FrameInputs::extent is " + std::to_string(extent.width) + "x" + std::to_string(extent.height) +
                   ", allowed is 1x1 to EffectDesc::max_extent " + std::to_string(desc.max_extent.width) + "x" +
                   std::to_string(desc.max_extent.height));
  }
  if (inputs.color.view == VK_NULL_HANDLE) return invalid("FrameInputs::color has no view");
  if (inputs.depth.view == VK_NULL_HANDLE) return invalid("FrameInputs::depth has no view");
  if (inputs.output.view == VK_NULL_HANDLE) return invalid("FrameInputs::output has no view");
  if (inputs.output.layout != VK_IMAGE_LAYOUT_GENERAL) {
    return invalid("FrameInputs::output must be in VK_IMAGE_LAYOUT_GENERAL");
  }
  if (inputs.cascades.size() > kMaxCascades) {
    return invalid("FrameInputs::cascades has " + std::to_string(inputs.cascades.size()) + " entries, at most " +
                   std::to_string(kMaxCascades) + " are allowed");
  }
  if (!inputs.cascades.empty()) {
    if (inputs.shadow_maps.view == VK_NULL_HANDLE) return invalid("FrameInputs::shadow_maps has no view");
    if (inputs.shadow_resolution == 0) return invalid("FrameInputs::shadow_resolution is 0");
    if (inputs.shadow_colors.view != VK_NULL_HANDLE && inputs.shadow_colors.view == inputs.shadow_maps.view) {
      return invalid("FrameInputs::shadow_colors is the view of FrameInputs::shadow_maps, it must be one of colours, or null");
    }
    if (inputs.shadow_colors.view != VK_NULL_HANDLE && !desc.shadow_colors) {
      return invalid("there are FrameInputs::shadow_colors, which need EffectDesc::shadow_colors");
    }
    if (inputs.shadow_colors.view != VK_NULL_HANDLE && inputs.shadow_colors.layout == VK_IMAGE_LAYOUT_UNDEFINED) {
      return invalid("FrameInputs::shadow_colors is in VK_IMAGE_LAYOUT_UNDEFINED, it must be in a layout that can be sampled");
    }
    if (inputs.first_marched_cascade >= inputs.cascades.size()) {
      return invalid("FrameInputs::first_marched_cascade is " + std::to_string(inputs.first_marched_cascade) +
                     ", it must be below the number of cascades, " + std::to_string(inputs.cascades.size()));
    }
  }
  for (const Cascade& cascade : inputs.cascades) {
    if (!finite(cascade.shadow_from_world)) return invalid("a matrix of FrameInputs::cascades is not finite");
    if (!(cascade.near_m >= 0.0F && cascade.far_m >= cascade.near_m)) {
      return invalid("a cascade's near_m and far_m must satisfy 0 <= near_m <= far_m");
    }
  }
  if (!finite(inputs.camera.world_from_view)) return invalid("Camera::world_from_view is not finite");
  if (!finite(inputs.camera.clip_from_view) || !finite(inverse(inputs.camera.clip_from_view))) {
    return invalid("Camera::clip_from_view is not finite or cannot be inverted");
  }
  const Vec3 sun = inputs.sun.direction_to_sun;
  if (!finite(sun) || (sun.x == 0.0F && sun.y == 0.0F && sun.z == 0.0F)) {
    return invalid("Sun::direction_to_sun is not a direction");
  }
  const Vec3 irradiance = inputs.sun.irradiance;
  if (!finite(irradiance) || irradiance.x < 0.0F || irradiance.y < 0.0F || irradiance.z < 0.0F) {
    return invalid("Sun::irradiance must be finite and not negative");
  }
  if (!std::isfinite(inputs.sun.angular_radius_rad) || inputs.sun.angular_radius_rad < 0.0F) {
    return invalid("Sun::angular_radius_rad must be finite and not negative");
  }
  if (params.scattering.technique == Technique::epipolar && params.scattering.light_shafts) {
    const std::size_t marched = inputs.cascades.empty() ? 0 : inputs.cascades.size() - inputs.first_marched_cascade;
    if (marched > desc.max_cascades) {
      return invalid("FrameInputs::cascades has " + std::to_string(marched) +
                     " cascades to march, at most EffectDesc::max_cascades, " + std::to_string(desc.max_cascades) +
                     ", are allowed");
    }
  }
  return {};
}

void remark_on_frame(const FrameInputs& inputs, const Params& params, const DeviceInfo& device) {
  if (device.message == nullptr) return;
  const auto say = [&](std::string_view text) { device.message(device.message_user, Severity::warning, text); };
  const Vec3 sun = inputs.sun.direction_to_sun;
  const float squared = sun.x * sun.x + sun.y * sun.y + sun.z * sun.z;
  if (std::abs(squared - 1.0F) > 1e-3F) {
    say("Sun::direction_to_sun is not of unit length: it is normalised, but is it a direction, and towards the sun?");
  }
  if (inputs.sun.irradiance.x + inputs.sun.irradiance.y + inputs.sun.irradiance.z <= 0.0F) {
    say("Sun::irradiance is 0: the air will be black");
  }
  if (params.scattering.light_shafts && inputs.cascades.empty()) {
    say("scattering.light_shafts is on, but there are no shadow cascades: nothing will be shadowed");
  }
  if (inputs.shadow_colors.view != VK_NULL_HANDLE && (inputs.cascades.empty() || !params.scattering.light_shafts)) {
    say("there are shadow_colors, but no light shafts for them: nothing will be coloured");
  }
  if (!inputs.cascades.empty() && inputs.first_marched_cascade < inputs.cascades.size() &&
      inputs.cascades[inputs.first_marched_cascade].near_m > 1.0F) {
    say("the first marched cascade does not start at the camera: the air before it is taken as lit");
  }
  const float* m = inputs.camera.world_from_view.m;
  const double radius = params.planet.radius_m;
  const double altitude = std::hypot(static_cast<double>(m[12]), static_cast<double>(m[13]) + radius,
                                     static_cast<double>(m[14])) - radius;
  if (altitude < -500.0) {
    say("the camera is more than 500 m below sea level: is y up, and the unit the metre?");
  }
}

}  // namespace tyndall
