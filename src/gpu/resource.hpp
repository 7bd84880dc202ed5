// Images and buffers with their memory. One allocation each: the few dozen of a frame do not need more.
#pragma once

#include <optional>
#include <span>

#include "gpu/device.hpp"

namespace tyndall::gpu {

struct ImageDesc {
  const char* name;
  VkFormat format;
  VkExtent3D extent;  // depth > 1 makes a 3D image
  VkImageUsageFlags usage;
  std::uint32_t layers = 1;
  std::uint32_t levels = 1;
  bool array = false;  // the view is of an array even with one layer
};

struct Image {
  Handle<VkDeviceMemory> memory;
  Handle<VkImage> image;
  Handle<VkImageView> view;  // all layers and levels; an array view when layers > 1 or desc.array
  ImageDesc desc = {};
  VkDeviceSize bytes = 0;
};

struct Buffer {
  Handle<VkDeviceMemory> memory;
  Handle<VkBuffer> buffer;
  void* mapped = nullptr;  // host-visible buffers stay mapped
  VkDeviceSize size = 0;   // bytes that the caller asked for
  VkDeviceSize bytes = 0;  // bytes of memory that it takes
};

enum class MemoryKind {
  device,    // fastest for the device
  upload,    // host writes, coherent
  readback,  // host reads, coherent, cached where possible
};

[[nodiscard]] VkImageCreateInfo image_create_info(const ImageDesc& desc);
[[nodiscard]] VkImageAspectFlags aspect_of(VkFormat format);

Result<Image> create_image(const Device& device, const ImageDesc& desc);
// A view of one layer (2D) of an image.
Result<Handle<VkImageView>> create_layer_view(const Device& device, const Image& image, std::uint32_t layer);
Result<Buffer> create_buffer(const Device& device, const char* name, VkDeviceSize size, VkBufferUsageFlags usage,
                             MemoryKind kind);

// Bytes of memory that create_image or create_buffer would take, without creating anything.
[[nodiscard]] VkDeviceSize image_bytes(const Device& device, const ImageDesc& desc);
[[nodiscard]] VkDeviceSize buffer_bytes(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage);

struct SamplerDesc {
  VkFilter filter = VK_FILTER_LINEAR;
  std::optional<VkFilter> min_filter = {};  // where the image is minified; `filter` if none
  VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  std::optional<VkSamplerAddressMode> address_v = {};  // in the second direction; `address` if none
  VkBorderColor border = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
  bool between_levels = false;  // mixes the two nearest mip levels
  bool first_level_only = false;
  bool compare = false;
  VkCompareOp compare_op = VK_COMPARE_OP_LESS_OR_EQUAL;
};
Result<Handle<VkSampler>> create_sampler(const Device& device, const SamplerDesc& desc);

// Moves a whole image between layouts, waiting for everything before and blocking everything after:
// for set-up and readback, not between the passes of a frame.
void transition(const Device& device, VkCommandBuffer cmd, const Image& image, VkImageLayout from, VkImageLayout to);

}  // namespace tyndall::gpu
