#include "effect/froxel_volume.hpp"

#include <string>
#include <utility>

#include "gpu/try.hpp"

namespace tyndall {
namespace {

bool same(const VkExtent3D& a, const VkExtent3D& b) {
  return a.width == b.width && a.height == b.height && a.depth == b.depth;
}

gpu::ImageDesc image_desc(std::uint32_t image, const Params& params) {
  return {FroxelVolume::kNames[image], VK_FORMAT_R16G16B16A16_SFLOAT, froxel_extent(params),
          VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
}

}  // namespace

bool uses_froxels(const Params& params) {
  return params.froxels.enabled || params.scattering.technique == Technique::froxels;
}

VkExtent3D froxel_extent(const Params& params) {
  const FroxelParams& p = params.froxels;
  return uses_froxels(params) ? VkExtent3D{p.columns, p.rows, p.slices} : VkExtent3D{0, 0, 0};
}

VkDeviceSize froxel_bytes(const gpu::Device& device, const EffectDesc& desc, const Params& params) {
  if (!uses_froxels(params)) return 0;
  return desc.views *
         (gpu::image_bytes(device, image_desc(0, params)) + gpu::image_bytes(device, image_desc(1, params)));
}

Result<void> check_froxels(const gpu::Device& device, const Params& params) {
  if (!uses_froxels(params)) return {};
  const VkDeviceSize bytes = gpu::image_bytes(device, image_desc(0, params));
  if (bytes <= device.max_allocation_bytes) return {};
  return Error{ErrorCode::invalid_argument,
               "froxels.columns, froxels.rows and froxels.slices need an image of " + std::to_string(bytes) +
                   " bytes; expected at most the limit of this device, " + std::to_string(device.max_allocation_bytes)};
}

VkDeviceSize FroxelVolume::Images::bytes(std::uint32_t image) const {
  VkDeviceSize sum = 0;
  for (const auto& view : views) sum += view[image].bytes;
  return sum;
}

Result<FroxelVolume::Pending> FroxelVolume::plan(const EffectDesc& desc, const Params& params) {
  Pending pending;
  const VkExtent3D extent = froxel_extent(params);
  pending.replaces = !same(extent, images_.extent);
  if (!pending.replaces) return pending;
  pending.images.extent = extent;
  if (extent.width > 0) pending.images.views.resize(desc.views);
  for (auto& view : pending.images.views) {
    for (std::uint32_t i = 0; i < kImages; ++i) {
      TYNDALL_ASSIGN(view[i], gpu::create_image(*device_, image_desc(i, params)));
    }
  }
  retired_.reserve(retired_.size() + 1);  // commit() must not allocate
  return pending;
}

void FroxelVolume::commit(Pending&& pending, std::uint32_t frames) noexcept {
  if (!pending.replaces) return;
  if (!images_.views.empty()) retired_.push_back({std::move(images_), frames});
  images_ = std::move(pending.images);
  ready_ = images_.views.empty();
}

void FroxelVolume::begin_frame(VkCommandBuffer cmd) {
  for (Retired& r : retired_) --r.frames_left;
  std::erase_if(retired_, [](const Retired& r) { return r.frames_left == 0; });
  if (ready_) return;
  for (const auto& view : images_.views) {
    for (const gpu::Image& image : view) {
      gpu::transition(*device_, cmd, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    }
  }
  ready_ = true;
}

VkImageView FroxelVolume::view_of(std::uint32_t view, std::uint32_t image) const {
  return view < images_.views.size() ? images_.views[view][image].view.get() : VK_NULL_HANDLE;
}

VkDeviceSize FroxelVolume::retired_bytes() const {
  VkDeviceSize sum = 0;
  for (const Retired& r : retired_) sum += r.images.bytes();
  return sum;
}

}  // namespace tyndall
