// Images and buffers with their memory. Each has its own allocation, which suffices for the few dozen of a frame, or a
// block of the allocator of DeviceInfo::memory.
#pragma once

#include <optional>
#include <span>
#include <utility>

#include "gpu/device.hpp"

namespace tyndall::gpu {

struct ImageDesc {
  const char* name;
  VkFormat format;
  VkExtent3D extent;  // depth > 1 makes a 3D image
  VkImageUsageFlags usage;
  std::uint32_t layers = 1;
  std::uint32_t levels = 1;
  bool array = false;  // create an array view even if there is only one layer
  bool cube = false;   // `layers` is 6, and the view is that of a cube map
};

// The owner of the memory of an image or a buffer.
class Memory {
 public:
  Memory() = default;
  Memory(const Device& device, const MemoryBlock& block, VkDeviceSize bytes)
      : device_(&device), block_(block), bytes_(bytes) {}
  Memory(Memory&& other) noexcept
      : device_(std::exchange(other.device_, nullptr)), block_(other.block_), bytes_(other.bytes_) {}
  Memory& operator=(Memory&& other) noexcept;
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() { reset(); }
  [[nodiscard]] const MemoryBlock& block() const { return block_; }
  void set_mapped(void* address) { block_.mapped = address; }

 private:
  void reset() noexcept;

  const Device* device_ = nullptr;  // null: owns nothing
  MemoryBlock block_ = {};
  VkDeviceSize bytes_ = 0;
};

struct Image {
  Image() = default;
  Image(Image&&) noexcept = default;
  Image& operator=(Image&& other) noexcept;
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;
  ~Image() = default;

  Memory memory;  // before what is bound to it, so that it is freed last
  Handle<VkImage> image;
  Handle<VkImageView> view;  // all layers and levels; an array view if layers > 1 or desc.array, unless desc.cube
  ImageDesc desc = {};
  VkDeviceSize bytes = 0;
};

struct Buffer {
  Buffer() = default;
  Buffer(Buffer&&) noexcept = default;
  Buffer& operator=(Buffer&& other) noexcept;
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() = default;

  Memory memory;
  Handle<VkBuffer> buffer;
  void* mapped = nullptr;  // address of a host-visible buffer, which is always mapped
  VkDeviceSize size = 0;   // requested size [bytes]
  VkDeviceSize bytes = 0;  // allocated memory [bytes]
};

enum class MemoryKind {
  device,     // device-local if possible
  upload,     // written by the host; coherent
  constants,  // written by the host for every frame; coherent, and device-local if possible
  readback,   // read by the host; coherent, and cached if possible
};

[[nodiscard]] VkImageCreateInfo image_create_info(const ImageDesc& desc);
[[nodiscard]] VkImageAspectFlags aspect_of(VkFormat format);

Result<Image> create_image(const Device& device, const ImageDesc& desc);
// Creates a 2D view of one layer.
Result<Handle<VkImageView>> create_layer_view(const Device& device, const Image& image, std::uint32_t layer);
Result<Buffer> create_buffer(const Device& device, const char* name, VkDeviceSize size, VkBufferUsageFlags usage,
                             MemoryKind kind);

// Returns the memory that create_image() or create_buffer() would allocate [bytes], without creating anything.
[[nodiscard]] VkDeviceSize image_bytes(const Device& device, const ImageDesc& desc);
[[nodiscard]] VkDeviceSize buffer_bytes(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage);

struct SamplerDesc {
  VkFilter filter = VK_FILTER_LINEAR;
  std::optional<VkFilter> min_filter = {};  // for minification; default: `filter`
  VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  std::optional<VkSamplerAddressMode> address_v = {};  // for the second coordinate; default: `address`
  VkBorderColor border = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
  bool between_levels = false;  // interpolate between mip levels
  bool first_level_only = false;
  bool compare = false;
  VkCompareOp compare_op = VK_COMPARE_OP_LESS_OR_EQUAL;
};
Result<Handle<VkSampler>> create_sampler(const Device& device, const SamplerDesc& desc);

// Records a layout transition of a whole image with a full barrier. For set-up and readback; between the passes of a
// frame this would be too slow.
void transition(const Device& device, VkCommandBuffer cmd, const Image& image, VkImageLayout from, VkImageLayout to);

}  // namespace tyndall::gpu
