#include "gpu/resource.hpp"

#include "gpu/try.hpp"

namespace tyndall::gpu {
namespace {

VkBufferCreateInfo buffer_create_info(VkDeviceSize size, VkBufferUsageFlags usage) {
  VkBufferCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = size;
  info.usage = usage;
  return info;
}

struct Properties {
  VkMemoryPropertyFlags needed, preferred;
};

Properties properties_of(MemoryKind kind) {
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  switch (kind) {
    case MemoryKind::upload: return {kHost, kHost};
    case MemoryKind::constants: return {kHost, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | kHost};
    case MemoryKind::readback: return {kHost, kHost | VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
    default: return {0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT};
  }
}

// Allocates from the device, and maps memory that the host needs.
Result<Memory> allocate_from_device(const Device& device, const MemoryRequest& request) {
  const std::uint32_t bits = request.requirements.memoryTypeBits;
  VkMemoryAllocateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  info.allocationSize = request.requirements.size;
  info.memoryTypeIndex = find_memory_type(device, bits, request.preferred);
  if (info.memoryTypeIndex == VK_MAX_MEMORY_TYPES)
    info.memoryTypeIndex = find_memory_type(device, bits, request.needed);
  if (info.memoryTypeIndex == VK_MAX_MEMORY_TYPES) {
    return Error{ErrorCode::unsupported_device, std::string("no memory type of the device can hold ") + request.name};
  }
  MemoryBlock block;
  VkResult result = device.vk.AllocateMemory(device.device, &info, device.allocator, &block.memory);
  if (result != VK_SUCCESS) return vulkan_error(result, "allocating the memory", request.name);
  Memory owner(device, block, info.allocationSize);
  if ((request.needed & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0) {
    result = device.vk.MapMemory(device.device, block.memory, 0, VK_WHOLE_SIZE, 0, &block.mapped);
    if (result != VK_SUCCESS) return vulkan_error(result, "mapping the memory", request.name);
    owner.set_mapped(block.mapped);
  }
  return owner;
}

// Allocates with the callbacks of the engine, and checks what they return.
Result<Memory> allocate_from_engine(const Device& device, const MemoryRequest& request) {
  const MemoryCallbacks& callbacks = device.memory_callbacks;
  MemoryBlock block;
  const VkResult result = callbacks.allocate(callbacks.user, request, block);
  if (result != VK_SUCCESS) {
    Error error = vulkan_error(result, "allocating the memory with MemoryCallbacks::allocate", request.name);
    error.code = ErrorCode::out_of_memory;
    return error;
  }
  const auto invalid = [&](const char* what) {
    return Error{ErrorCode::invalid_argument,
                 std::string("MemoryCallbacks::allocate: the block for ") + request.name + " has " + what};
  };
  if (block.memory == VK_NULL_HANDLE) return invalid("no memory; expected a VkDeviceMemory, or an error");
  Memory owner(device, block, request.requirements.size);
  if (block.offset % request.requirements.alignment != 0) {
    return invalid("an offset that is not aligned; expected a multiple of requirements.alignment");
  }
  if ((request.needed & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0 && block.mapped == nullptr) {
    return invalid("no address on the host; expected mapped memory");
  }
  return owner;
}

Result<Memory> allocate(const Device& device, MemoryRequest request, MemoryKind kind) {
  const Properties properties = properties_of(kind);
  request.needed = properties.needed;
  request.preferred = properties.preferred;
  return device.memory_callbacks.allocate != nullptr ? allocate_from_engine(device, request)
                                                     : allocate_from_device(device, request);
}

Result<Handle<VkImageView>> create_view(const Device& device, const Image& image, VkImageViewType type,
                                        std::uint32_t first_layer, std::uint32_t layers) {
  VkImageViewCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  info.image = image.image.get();
  info.viewType = type;
  info.format = image.desc.format;
  info.subresourceRange = {aspect_of(image.desc.format), 0, image.desc.levels, first_layer, layers};
  VkImageView view = VK_NULL_HANDLE;
  const VkResult result = device.vk.CreateImageView(device.device, &info, device.allocator, &view);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating the view", image.desc.name);
  set_name(device, VK_OBJECT_TYPE_IMAGE_VIEW, view, image.desc.name);
  return Handle<VkImageView>(device, view);
}

}  // namespace

Memory& Memory::operator=(Memory&& other) noexcept {
  if (this != &other) {
    reset();
    device_ = std::exchange(other.device_, nullptr);
    block_ = other.block_;
    bytes_ = other.bytes_;
  }
  return *this;
}

void Memory::reset() noexcept {
  if (device_ == nullptr) return;
  const MemoryCallbacks& callbacks = device_->memory_callbacks;
  if (callbacks.free != nullptr) {
    callbacks.free(callbacks.user, block_, bytes_);
  } else {
    device_->vk.FreeMemory(device_->device, block_.memory, device_->allocator);
  }
  device_ = nullptr;
}

VkImageCreateInfo image_create_info(const ImageDesc& desc) {
  VkImageCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = desc.extent.depth > 1 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
  info.format = desc.format;
  info.extent = desc.extent;
  info.mipLevels = desc.levels;
  info.arrayLayers = desc.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = desc.usage;
  if (desc.cube) info.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  return info;
}

VkImageAspectFlags aspect_of(VkFormat format) {
  return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

// Assigning the members in their order would free the memory before what is bound to it.
Image& Image::operator=(Image&& other) noexcept {
  view = std::move(other.view);
  image = std::move(other.image);
  memory = std::move(other.memory);
  desc = other.desc;
  bytes = other.bytes;
  return *this;
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  buffer = std::move(other.buffer);
  memory = std::move(other.memory);
  mapped = other.mapped;
  size = other.size;
  bytes = other.bytes;
  return *this;
}

Result<Image> create_image(const Device& device, const ImageDesc& desc) {
  Image out;
  out.desc = desc;
  const VkImageCreateInfo info = image_create_info(desc);
  VkImage image = VK_NULL_HANDLE;
  VkResult result = device.vk.CreateImage(device.device, &info, device.allocator, &image);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating the image", desc.name);
  out.image = Handle<VkImage>(device, image);
  set_name(device, VK_OBJECT_TYPE_IMAGE, image, desc.name);
  VkMemoryRequirements requirements = {};
  device.vk.GetImageMemoryRequirements(device.device, image, &requirements);
  MemoryRequest request;
  request.name = desc.name;
  request.image = image;
  request.usage = desc.usage;
  request.requirements = requirements;
  TYNDALL_ASSIGN(out.memory, allocate(device, request, MemoryKind::device));
  out.bytes = requirements.size;
  const MemoryBlock& block = out.memory.block();
  result = device.vk.BindImageMemory(device.device, image, block.memory, block.offset);
  if (result != VK_SUCCESS) return vulkan_error(result, "binding the memory", desc.name);
  VkImageViewType type = desc.layers > 1 || desc.array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  if (desc.extent.depth > 1) type = VK_IMAGE_VIEW_TYPE_3D;
  if (desc.cube) type = VK_IMAGE_VIEW_TYPE_CUBE;
  TYNDALL_ASSIGN(out.view, create_view(device, out, type, 0, desc.layers));
  return out;
}

Result<Handle<VkImageView>> create_layer_view(const Device& device, const Image& image, std::uint32_t layer) {
  return create_view(device, image, VK_IMAGE_VIEW_TYPE_2D, layer, 1);
}

Result<Buffer> create_buffer(const Device& device, const char* name, VkDeviceSize size, VkBufferUsageFlags usage,
                             MemoryKind kind) {
  Buffer out;
  out.size = size;
  const VkBufferCreateInfo info = buffer_create_info(size, usage);
  VkBuffer buffer = VK_NULL_HANDLE;
  VkResult result = device.vk.CreateBuffer(device.device, &info, device.allocator, &buffer);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating the buffer", name);
  out.buffer = Handle<VkBuffer>(device, buffer);
  set_name(device, VK_OBJECT_TYPE_BUFFER, buffer, name);
  VkMemoryRequirements requirements = {};
  device.vk.GetBufferMemoryRequirements(device.device, buffer, &requirements);
  MemoryRequest request;
  request.name = name;
  request.buffer = buffer;
  request.usage = usage;
  request.requirements = requirements;
  TYNDALL_ASSIGN(out.memory, allocate(device, request, kind));
  out.bytes = requirements.size;
  const MemoryBlock& block = out.memory.block();
  result = device.vk.BindBufferMemory(device.device, buffer, block.memory, block.offset);
  if (result != VK_SUCCESS) return vulkan_error(result, "binding the memory", name);
  if (kind != MemoryKind::device) out.mapped = block.mapped;
  return out;
}

VkDeviceSize image_bytes(const Device& device, const ImageDesc& desc) {
  const VkImageCreateInfo info = image_create_info(desc);
  VkDeviceImageMemoryRequirements query = {};
  query.sType = VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS;
  query.pCreateInfo = &info;
  VkMemoryRequirements2 requirements = {VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2, nullptr, {}};
  device.vk.GetDeviceImageMemoryRequirements(device.device, &query, &requirements);
  return requirements.memoryRequirements.size;
}

VkDeviceSize buffer_bytes(const Device& device, VkDeviceSize size, VkBufferUsageFlags usage) {
  const VkBufferCreateInfo info = buffer_create_info(size, usage);
  VkDeviceBufferMemoryRequirements query = {};
  query.sType = VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS;
  query.pCreateInfo = &info;
  VkMemoryRequirements2 requirements = {VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2, nullptr, {}};
  device.vk.GetDeviceBufferMemoryRequirements(device.device, &query, &requirements);
  return requirements.memoryRequirements.size;
}

Result<Handle<VkSampler>> create_sampler(const Device& device, const SamplerDesc& desc) {
  VkSamplerCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  info.magFilter = desc.filter;
  info.minFilter = desc.min_filter.value_or(desc.filter);
  info.mipmapMode = desc.between_levels ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = info.addressModeW = desc.address;
  info.addressModeV = desc.address_v.value_or(desc.address);
  info.compareEnable = desc.compare ? VK_TRUE : VK_FALSE;
  info.compareOp = desc.compare_op;
  // A maximum of 0.25 selects the first level only, but still distinguishes minification from magnification (Vulkan
  // 1.3, VkSamplerCreateInfo, on GL_NEAREST and GL_LINEAR).
  info.maxLod = desc.first_level_only ? 0.25F : VK_LOD_CLAMP_NONE;
  info.borderColor = desc.border;
  VkSampler sampler = VK_NULL_HANDLE;
  const VkResult result = device.vk.CreateSampler(device.device, &info, device.allocator, &sampler);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating", "a sampler");
  return Handle<VkSampler>(device, sampler);
}

void transition(const Device& device, VkCommandBuffer cmd, const Image& image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier info = {};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  info.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT | VK_ACCESS_MEMORY_READ_BIT;
  info.dstAccessMask = VK_ACCESS_MEMORY_WRITE_BIT | VK_ACCESS_MEMORY_READ_BIT;
  info.oldLayout = from;
  info.newLayout = to;
  info.srcQueueFamilyIndex = info.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  info.image = image.image.get();
  info.subresourceRange = {aspect_of(image.desc.format), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
  device.vk.CmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                               nullptr, 0, nullptr, 1, &info);
}

}  // namespace tyndall::gpu
