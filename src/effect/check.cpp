// Checks of the inputs of a frame. Messages use the names of the public interface.
#include <cmath>
#include <string>

#include "effect/frame_constants.hpp"
#include "effect/frame_geometry.hpp"
#include "effect/invalid.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

bool finite(const Mat4& m) {
  for (const float entry : m.m) {
    if (!std::isfinite(entry)) return false;
  }
  return true;
}

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Returns whether shaders can sample an image in this layout. Layouts of extensions are accepted.
bool can_be_sampled(VkImageLayout layout) {
  switch (layout) {
    case VK_IMAGE_LAYOUT_UNDEFINED:
    case VK_IMAGE_LAYOUT_PREINITIALIZED:
    case VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL:
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL:
    case VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL:
    case VK_IMAGE_LAYOUT_STENCIL_ATTACHMENT_OPTIMAL:
    case VK_IMAGE_LAYOUT_STENCIL_READ_ONLY_OPTIMAL:
    case VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL:
    case VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL:
    case VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL:
    case VK_IMAGE_LAYOUT_PRESENT_SRC_KHR: return false;
    default: return true;
  }
}

Result<void> check_layout(const Texture& texture, const char* name) {
  if (can_be_sampled(texture.layout)) return {};
  return invalid(std::string(name) + "'s layout is " + std::to_string(static_cast<int>(texture.layout)) +
                 " (of VkImageLayout); expected one that can be sampled, such as SHADER_READ_ONLY_OPTIMAL or GENERAL");
}

// Returns an error for a camera with which the picture would certainly be wrong.
Result<void> check_camera(const Camera& camera, const EffectDesc& desc) {
  constexpr double kRigid = 1e-2;
  if (affine_error(camera.world_from_view) > 1e-4) {
    return invalid("Camera::world_from_view has a last row other than 0 0 0 1; expected a rigid matrix, column-major: "
                   "is it transposed?");
  }
  if (orthonormal_error(camera.world_from_view) > kRigid) {
    return invalid("Camera::world_from_view is scaled or sheared: the first column is " +
                   std::to_string(length(column_of(camera.world_from_view, 0))) +
                   " long; expected a rigid matrix, whose first three columns are orthonormal");
  }
  const Projection p = projection_of(camera.clip_from_view);
  if (!p.perspective) {
    return invalid(
        "Camera::clip_from_view is orthographic, which is not supported; expected a perspective projection, with a "
        "last row of 0 0 -1 0");
  }
  if (!p.forward) {
    return invalid("Camera::clip_from_view looks down +z of the view; expected one that looks down -z, with a last row "
                   "of 0 0 -1 0");
  }
  // Device depth decreases with distance if the slope is positive.
  const float far_side = p.depth_slope > 0.0 ? 0.0F : 1.0F;
  if (far_side != desc.sky_depth) {
    return invalid("EffectDesc::sky_depth is " + std::to_string(static_cast<int>(desc.sky_depth)) +
                   ", but the depth of Camera::clip_from_view " + (p.depth_slope > 0.0 ? "falls" : "rises") +
                   " with the distance; expected " + (p.depth_slope > 0.0 ? "0 (reversed Z)" : "1"));
  }
  return {};
}

// Returns what is wrong with a matrix to (u, v, depth) of an orthographic map, or null. Allocates nothing.
const char* map_matrix_fault(const Mat4& m) {
  if (!finite(m)) return " is not finite; expected a matrix from the world to (u, v, depth)";
  // The tolerance is far below that of any usable map.
  const double volume = determinant3(m);
  const double rows = length(row_of(m, 0)) * length(row_of(m, 1)) * length(row_of(m, 2));
  if (!(std::abs(volume) > 1e-4 * rows) || !(rows > 0.0)) {
    return " is zero or cannot be inverted; expected a matrix from the world to (u, v, depth)";
  }
  if (affine_error(m) > 1e-4) {
    return " has a last row other than 0 0 0 1; expected the matrix of an orthographic map, column-major: is it "
           "transposed, or a perspective one?";
  }
  return nullptr;
}

Result<void> check_cascade(const Cascade& cascade, std::size_t index) {
  const auto fault = [&](const std::string& what) {
    return invalid("FrameInputs::cascades[" + std::to_string(index) + "]" + what);
  };
  if (const char* const what = map_matrix_fault(cascade.shadow_from_world); what != nullptr) {
    return fault(std::string("'s shadow_from_world") + what);
  }
  if (!(cascade.near_m >= 0.0F && cascade.far_m >= cascade.near_m && std::isfinite(cascade.far_m))) {
    return fault("'s range is " + std::to_string(cascade.near_m) + " to " + std::to_string(cascade.far_m) +
                 " m; expected finite numbers, 0 <= near_m <= far_m");
  }
  return {};
}

Result<void> check_sun(const Sun& sun) {
  const Vec3 direction = sun.direction_to_sun;
  if (!finite(direction) || (direction.x == 0.0F && direction.y == 0.0F && direction.z == 0.0F)) {
    return invalid("Sun::direction_to_sun is zero or not finite; expected a direction");
  }
  const Vec3 irradiance = sun.irradiance;
  if (!finite(irradiance) || irradiance.x < 0.0F || irradiance.y < 0.0F || irradiance.z < 0.0F) {
    return invalid("Sun::irradiance is negative or not finite; expected at least 0");
  }
  if (!std::isfinite(sun.angular_radius_rad) || sun.angular_radius_rad < 0.0F) {
    return invalid("Sun::angular_radius_rad is negative or not finite; expected at least 0");
  }
  return {};
}

// Returns an error for an offset that exceeds the size of any image, because it would overflow in the shaders.
Result<void> check_offset(const Texture& texture, const char* name) {
  constexpr std::int32_t kMaxOffset = 1 << 20;
  const VkOffset2D o = texture.offset;
  if (o.x >= 0 && o.y >= 0 && o.x <= kMaxOffset && o.y <= kMaxOffset) return {};
  return invalid(std::string(name) + "'s offset is " + std::to_string(o.x) + "," + std::to_string(o.y) +
                 "; expected pixels inside the image, from 0,0 on");
}

Result<void> check_clouds(const FrameInputs& inputs, const EffectDesc& desc) {
  const Texture& map = inputs.clouds.map;
  if (map.view == VK_NULL_HANDLE) return {};
  if (!desc.clouds) return invalid("FrameInputs::clouds has a view; expected null without EffectDesc::clouds");
  TYNDALL_TRY(check_layout(map, "FrameInputs::clouds.map"));
  if (map.offset.x != 0 || map.offset.y != 0) {
    return invalid("FrameInputs::clouds.map has an offset; expected 0,0, because the map is used completely");
  }
  if (map.view == inputs.output.view || map.view == inputs.depth.view || map.view == inputs.shadow_maps.view) {
    return invalid(
        "FrameInputs::clouds.map is the view of FrameInputs::output, depth or shadow_maps; expected an image "
        "of transmittances and depths");
  }
  if (const char* const what = map_matrix_fault(inputs.clouds.map_from_world); what != nullptr) {
    return invalid(std::string("FrameInputs::clouds's map_from_world") + what);
  }
  return {};
}

}  // namespace

Result<void> check_frame(const FrameInputs& inputs, const EffectDesc& desc, const Params& params) {
  const VkExtent2D extent = inputs.extent;
  if (extent.width == 0 || extent.height == 0 || extent.width > desc.max_extent.width ||
      extent.height > desc.max_extent.height) {
    return invalid("FrameInputs::extent is " + std::to_string(extent.width) + "x" + std::to_string(extent.height) +
                   "; expected 1x1 to EffectDesc::max_extent " + std::to_string(desc.max_extent.width) + "x" +
                   std::to_string(desc.max_extent.height));
  }
  if (inputs.color.view == VK_NULL_HANDLE) return invalid("FrameInputs::color has no view; expected a sampled image");
  if (inputs.depth.view == VK_NULL_HANDLE) return invalid("FrameInputs::depth has no view; expected a sampled image");
  if (inputs.output.view == VK_NULL_HANDLE) return invalid("FrameInputs::output has no view; expected a storage image");
  TYNDALL_TRY(check_layout(inputs.color, "FrameInputs::color"));
  TYNDALL_TRY(check_layout(inputs.depth, "FrameInputs::depth"));
  if (inputs.output.view == inputs.color.view || inputs.output.view == inputs.depth.view) {
    return invalid("FrameInputs::output is the view of FrameInputs::color or depth; expected an image of its own, "
                   "because both are read "
                   "while it is written");
  }
  if (inputs.view >= desc.views) {
    return invalid("FrameInputs::view is " + std::to_string(inputs.view) + "; expected below EffectDesc::views, " +
                   std::to_string(desc.views));
  }
  if (inputs.output.layout != VK_IMAGE_LAYOUT_GENERAL) {
    return invalid("FrameInputs::output is not in VK_IMAGE_LAYOUT_GENERAL; expected this layout");
  }
  TYNDALL_TRY(check_offset(inputs.color, "FrameInputs::color"));
  TYNDALL_TRY(check_offset(inputs.depth, "FrameInputs::depth"));
  TYNDALL_TRY(check_offset(inputs.output, "FrameInputs::output"));
  for (const Texture& texture : {inputs.shadow_maps, inputs.shadow_colors}) {
    if (texture.offset.x != 0 || texture.offset.y != 0) {
      return invalid("FrameInputs::shadow_maps or shadow_colors has an offset; expected 0,0, because shadow maps are "
                     "used completely");
    }
  }
  if (inputs.cascades.size() > kMaxCascades) {
    return invalid("FrameInputs::cascades has " + std::to_string(inputs.cascades.size()) +
                   " entries; expected at most " + std::to_string(kMaxCascades));
  }
  if (!inputs.cascades.empty()) {
    if (inputs.shadow_maps.view == VK_NULL_HANDLE)
      return invalid("FrameInputs::shadow_maps has no view; expected one if there are cascades");
    if (inputs.shadow_resolution == 0)
      return invalid("FrameInputs::shadow_resolution is 0; expected the width of the shadow maps");
    if (inputs.shadow_colors.view != VK_NULL_HANDLE && inputs.shadow_colors.view == inputs.shadow_maps.view) {
      return invalid(
          "FrameInputs::shadow_colors is the view of FrameInputs::shadow_maps; expected a view of colours, or null");
    }
    if (inputs.shadow_colors.view != VK_NULL_HANDLE && !desc.shadow_colors) {
      return invalid("FrameInputs::shadow_colors has a view; expected null without EffectDesc::shadow_colors");
    }
    TYNDALL_TRY(check_layout(inputs.shadow_maps, "FrameInputs::shadow_maps"));
    if (inputs.shadow_colors.view != VK_NULL_HANDLE) {
      TYNDALL_TRY(check_layout(inputs.shadow_colors, "FrameInputs::shadow_colors"));
    }
    if (inputs.first_marched_cascade >= inputs.cascades.size()) {
      return invalid("FrameInputs::first_marched_cascade is " + std::to_string(inputs.first_marched_cascade) +
                     "; expected less than the number of cascades, " + std::to_string(inputs.cascades.size()));
    }
  }
  for (std::size_t i = 0; i < inputs.cascades.size(); ++i) TYNDALL_TRY(check_cascade(inputs.cascades[i], i));
  TYNDALL_TRY(check_clouds(inputs, desc));
  if (!finite(inputs.camera.world_from_view))
    return invalid("Camera::world_from_view is not finite; expected a rigid matrix");
  if (!finite(inputs.camera.clip_from_view) || !finite(inverse(inputs.camera.clip_from_view))) {
    return invalid("Camera::clip_from_view is not finite or cannot be inverted; expected a perspective projection");
  }
  TYNDALL_TRY(check_camera(inputs.camera, desc));
  if (!std::isfinite(inputs.lowest_ground_m) || inputs.lowest_ground_m > 0.0F) {
    return invalid("FrameInputs::lowest_ground_m must be finite and not above 0");
  }
  TYNDALL_TRY(check_sun(inputs.sun));
  if (params.scattering.technique == Technique::epipolar && params.scattering.light_shafts) {
    const std::size_t marched = inputs.cascades.empty() ? 0 : inputs.cascades.size() - inputs.first_marched_cascade;
    if (marched > desc.max_cascades) {
      return invalid("FrameInputs::cascades has " + std::to_string(marched) +
                     " cascades to march; expected at most EffectDesc::max_cascades, " +
                     std::to_string(desc.max_cascades));
    }
  }
  return {};
}

}  // namespace tyndall
