// Synchronous copies between host and device through staging buffers, for set-up and readback.
#include <cstring>

#include "gpu/host.hpp"
#include "gpu/try.hpp"

namespace tyndall::gpu {
namespace {

VkBufferImageCopy whole_level(const Image& image, std::uint32_t first_layer, std::uint32_t layers) {
  VkBufferImageCopy copy = {};
  copy.imageSubresource = {aspect_of(image.desc.format), 0, first_layer, layers};
  copy.imageExtent = image.desc.extent;
  return copy;
}

}  // namespace

Result<void> upload(Host& host, const Buffer& to, const void* data, VkDeviceSize size) {
  const Device& device = host.device();
  TYNDALL_ASSIGN(const Buffer staging,
                 create_buffer(device, "staging", size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryKind::upload));
  std::memcpy(staging.mapped, data, size);
  return host.run([&](VkCommandBuffer cmd) -> Result<void> {
    const VkBufferCopy copy = {0, 0, size};
    device.vk.CmdCopyBuffer(cmd, staging.buffer.get(), to.buffer.get(), 1, &copy);
    barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
    return {};
  });
}

Result<void> upload(Host& host, const Image& to, const void* data, VkDeviceSize size, VkImageLayout layout) {
  const Device& device = host.device();
  TYNDALL_ASSIGN(const Buffer staging,
                 create_buffer(device, "staging", size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryKind::upload));
  std::memcpy(staging.mapped, data, size);
  return host.run([&](VkCommandBuffer cmd) -> Result<void> {
    transition(device, cmd, to, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkBufferImageCopy copy = whole_level(to, 0, to.desc.layers);
    device.vk.CmdCopyBufferToImage(cmd, staging.buffer.get(), to.image.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                                   &copy);
    transition(device, cmd, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout);
    return {};
  });
}

Result<std::vector<std::byte>> download(Host& host, const Image& from, VkImageLayout layout, std::uint32_t layer,
                                        std::uint32_t bytes_per_texel) {
  const Device& device = host.device();
  const VkExtent3D extent = from.desc.extent;
  const VkDeviceSize size = static_cast<VkDeviceSize>(extent.width) * extent.height * extent.depth * bytes_per_texel;
  TYNDALL_ASSIGN(const Buffer staging,
                 create_buffer(device, "readback", size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::readback));
  TYNDALL_TRY(host.run([&](VkCommandBuffer cmd) -> Result<void> {
    transition(device, cmd, from, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    const VkBufferImageCopy copy = whole_level(from, layer, 1);
    device.vk.CmdCopyImageToBuffer(cmd, from.image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.buffer.get(), 1,
                                   &copy);
    transition(device, cmd, from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout);
    barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
            VK_ACCESS_HOST_READ_BIT);
    return {};
  }));
  std::vector<std::byte> out(size);
  std::memcpy(out.data(), staging.mapped, size);
  return out;
}

Result<std::vector<std::byte>> download(Host& host, const Buffer& from, VkDeviceSize size) {
  const Device& device = host.device();
  TYNDALL_ASSIGN(const Buffer staging,
                 create_buffer(device, "readback", size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryKind::readback));
  TYNDALL_TRY(host.run([&](VkCommandBuffer cmd) -> Result<void> {
    barrier(device, cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
            VK_ACCESS_TRANSFER_READ_BIT);
    const VkBufferCopy copy = {0, 0, size};
    device.vk.CmdCopyBuffer(cmd, from.buffer.get(), staging.buffer.get(), 1, &copy);
    barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
            VK_ACCESS_HOST_READ_BIT);
    return {};
  }));
  std::vector<std::byte> out(size);
  std::memcpy(out.data(), staging.mapped, size);
  return out;
}

}  // namespace tyndall::gpu
