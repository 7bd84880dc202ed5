#include "effect/sky_cube.hpp"

#include <array>
#include <bit>
#include <string>

#include "gpu/try.hpp"

namespace tyndall {
namespace {

constexpr std::uint32_t kSmallest = 32, kLargest = 128;
constexpr std::uint32_t kMaxLevels = 8;
static_assert(kLargest >> (kMaxLevels - 1) == 1);
constexpr VkDeviceSize kCubeTexelBytes = 8;
constexpr VkBufferUsageFlags kRadianceUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkBufferUsageFlags kTexelsUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

// Returns the number of texels in the levels with faces of `size` to `last` texels.
VkDeviceSize texels(std::uint32_t size, std::uint32_t last) {
  return VkDeviceSize{8} * size * size - VkDeviceSize{2} * last * last;
}
VkDeviceSize radiance_bytes(std::uint32_t size) { return texels(size, shared::kSkyCubeCoarse) * 4 * sizeof(float); }
VkDeviceSize texel_bytes(std::uint32_t size) { return texels(size, 1) * kCubeTexelBytes; }

gpu::ImageDesc image_desc(std::uint32_t size) {
  gpu::ImageDesc out = {"sky_cube",
                        VK_FORMAT_R16G16B16A16_SFLOAT,
                        {size, size, 1},
                        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
  out.layers = 6;
  out.levels = static_cast<std::uint32_t>(std::bit_width(size));
  out.cube = true;
  return out;
}

}  // namespace

Result<void> check_cube_size(const char* where, std::uint32_t size) {
  if (size == 0 || (std::has_single_bit(size) && size >= kSmallest && size <= kLargest)) return {};
  return Error{ErrorCode::invalid_argument, std::string(where) + ": invalid SkyProbeDesc::cube_size " +
                                                std::to_string(size) + "; expected 0, 32, 64 or 128"};
}

VkDeviceSize sky_cube_bytes(const gpu::Device& device, std::uint32_t size) {
  if (size == 0) return 0;
  return gpu::buffer_bytes(device, radiance_bytes(size), kRadianceUsage) +
         gpu::buffer_bytes(device, texel_bytes(size), kTexelsUsage) + gpu::image_bytes(device, image_desc(size));
}

Result<SkyCubeMap> SkyCubeMap::create(const gpu::Device& device, std::uint32_t size) {
  SkyCubeMap out;
  if (size == 0) return out;
  out.device_ = &device;
  TYNDALL_ASSIGN(out.radiance_, gpu::create_buffer(device, "sky_cube_radiance", radiance_bytes(size), kRadianceUsage,
                                                   gpu::MemoryKind::device));
  TYNDALL_ASSIGN(out.texels_, gpu::create_buffer(device, "sky_cube_texels", texel_bytes(size), kTexelsUsage,
                                                 gpu::MemoryKind::device));
  TYNDALL_ASSIGN(out.image_, gpu::create_image(device, image_desc(size)));
  TYNDALL_ASSIGN(out.sampler_, gpu::create_sampler(device, {.between_levels = true}));
  return out;
}

void SkyCubeMap::bind(BoundResources& out) const {
  out.set(Resource::sky_cube_radiance, radiance_.buffer.get());
  out.set(Resource::sky_cube_texels, texels_.buffer.get());
}

void SkyCubeMap::record_clear(VkCommandBuffer cmd) const {
  if (device_ == nullptr) return;
  gpu::transition(*device_, cmd, image_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
  constexpr VkClearColorValue kBlack = {};
  constexpr VkImageSubresourceRange kWhole = {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0,
                                              VK_REMAINING_ARRAY_LAYERS};
  device_->vk.CmdClearColorImage(cmd, image_.image.get(), VK_IMAGE_LAYOUT_GENERAL, &kBlack, 1, &kWhole);
  gpu::transition(*device_, cmd, image_, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);
}

void SkyCubeMap::record_copy(VkCommandBuffer cmd) const {
  if (device_ == nullptr) return;
  std::array<VkBufferImageCopy, kMaxLevels> regions = {};
  VkDeviceSize offset = 0;
  for (std::uint32_t level = 0; level < image_.desc.levels; ++level) {
    const std::uint32_t width = image_.desc.extent.width >> level;
    regions[level].bufferOffset = offset;
    regions[level].imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 6};
    regions[level].imageExtent = {width, width, 1};
    offset += kCubeTexelBytes * 6 * width * width;
  }
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
               VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
               VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
  device_->vk.CmdCopyBufferToImage(cmd, texels_.buffer.get(), image_.image.get(), VK_IMAGE_LAYOUT_GENERAL,
                                   image_.desc.levels, regions.data());
  gpu::barrier(*device_, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
               VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

SkyCube SkyCubeMap::cube() const {
  if (device_ == nullptr) return {};
  return {image_.image.get(), image_.view.get(), sampler_.get(), image_.desc.extent.width, image_.desc.levels};
}

}  // namespace tyndall
