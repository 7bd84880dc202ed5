// The part of examples/engine.cpp and glass.cpp that every program with Vulkan has: a device and its description,
// images, barriers and submission. embed.cpp has the same in one file. An error ends the program with a number that
// names the step.
#pragma once

#include <tyndall/effect.hpp>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace host {

inline void need(bool condition, int status) {
  if (!condition) std::exit(status);
}

// Prints an error of the library, which says in one line where it happened, what is wrong and what is expected.
[[noreturn]] inline void fail(const tyndall::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  std::exit(1);
}

template <typename T>
T value_or_exit(tyndall::Result<T> result) {
  if (!result.ok()) fail(result.error());
  return std::move(result).value();
}

// A device with the requirements of Tyndall and nothing else.
struct Device {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer cmd = VK_NULL_HANDLE;
};

inline Device create_device() {
  Device out;
  const tyndall::Requirements requirements = tyndall::requirements();
  VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = requirements.api_version;
  VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  instance_info.pApplicationInfo = &application;
  need(vkCreateInstance(&instance_info, nullptr, &out.instance) == VK_SUCCESS, 20);
  std::uint32_t count = 1;
  vkEnumeratePhysicalDevices(out.instance, &count, &out.physical);
  need(count == 1, 21);
  const float priority = 1.0F;
  VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue_info.queueCount = 1;
  queue_info.pQueuePriorities = &priority;
  VkDeviceCreateInfo device_info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  device_info.queueCreateInfoCount = 1;
  device_info.pQueueCreateInfos = &queue_info;
  device_info.enabledExtensionCount = static_cast<std::uint32_t>(requirements.device_extensions.size());
  device_info.ppEnabledExtensionNames = requirements.device_extensions.data();
  need(vkCreateDevice(out.physical, &device_info, nullptr, &out.device) == VK_SUCCESS, 22);
  vkGetDeviceQueue(out.device, 0, 0, &out.queue);
  VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  need(vkCreateCommandPool(out.device, &pool_info, nullptr, &out.pool) == VK_SUCCESS, 23);
  VkCommandBufferAllocateInfo cmd_info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  cmd_info.commandPool = out.pool;
  cmd_info.commandBufferCount = 1;
  need(vkAllocateCommandBuffers(out.device, &cmd_info, &out.cmd) == VK_SUCCESS, 24);
  return out;
}

// Returns the description of the device for the library. A message of the library ends the program.
inline tyndall::DeviceInfo device_info(const Device& device) {
  tyndall::DeviceInfo info;
  info.instance = device.instance;
  info.physical_device = device.physical;
  info.device = device.device;
  info.get_instance_proc_addr = vkGetInstanceProcAddr;
  info.message = [](void*, tyndall::Severity, std::string_view text) {
    std::fprintf(stderr, "tyndall: %.*s\n", static_cast<int>(text.size()), text.data());
    std::exit(2);
  };
  return info;
}

// The engine's images, and a buffer to read the output on the host.
struct Image {
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};
struct Buffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
};

inline VkDeviceMemory allocate(const Device& device, const VkMemoryRequirements& requirements,
                               VkMemoryPropertyFlags flags) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(device.physical, &memory);
  VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = requirements.size;
  const auto fits = [&](std::uint32_t type) {
    return (requirements.memoryTypeBits >> type & 1U) != 0 && (memory.memoryTypes[type].propertyFlags & flags) == flags;
  };
  while (info.memoryTypeIndex < memory.memoryTypeCount && !fits(info.memoryTypeIndex)) ++info.memoryTypeIndex;
  need(info.memoryTypeIndex < memory.memoryTypeCount, 10);
  VkDeviceMemory out = VK_NULL_HANDLE;
  need(vkAllocateMemory(device.device, &info, nullptr, &out) == VK_SUCCESS, 11);
  return out;
}

inline Image create_image(const Device& device, VkExtent2D extent, VkFormat format, VkImageUsageFlags usage,
                          VkImageAspectFlags aspect, std::uint32_t layers = 1) {
  Image out;
  out.aspect = aspect;
  VkImageCreateInfo info = {VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {extent.width, extent.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage;
  need(vkCreateImage(device.device, &info, nullptr, &out.image) == VK_SUCCESS, 12);
  VkMemoryRequirements requirements;
  vkGetImageMemoryRequirements(device.device, out.image, &requirements);
  out.memory = allocate(device, requirements, 0);
  need(vkBindImageMemory(device.device, out.image, out.memory, 0) == VK_SUCCESS, 13);
  VkImageViewCreateInfo view = {VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = out.image;
  view.viewType = layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {aspect, 0, 1, 0, layers};
  need(vkCreateImageView(device.device, &view, nullptr, &out.view) == VK_SUCCESS, 14);
  return out;
}

inline Buffer create_buffer(const Device& device, VkDeviceSize bytes,
                            VkBufferUsageFlags usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  Buffer out;
  VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = usage;
  need(vkCreateBuffer(device.device, &info, nullptr, &out.buffer) == VK_SUCCESS, 25);
  VkMemoryRequirements requirements;
  vkGetBufferMemoryRequirements(device.device, out.buffer, &requirements);
  out.memory =
      allocate(device, requirements, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  need(vkBindBufferMemory(device.device, out.buffer, out.memory, 0) == VK_SUCCESS, 26);
  return out;
}

struct Images {
  Image color, depth, output;
  Buffer readback;
};

inline Images create_images(const Device& device, VkExtent2D extent) {
  const VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const VkImageUsageFlags write = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  Images out;
  out.color = create_image(device, extent, VK_FORMAT_R16G16B16A16_SFLOAT, read, VK_IMAGE_ASPECT_COLOR_BIT);
  out.depth = create_image(device, extent, VK_FORMAT_D32_SFLOAT, read, VK_IMAGE_ASPECT_DEPTH_BIT);
  out.output = create_image(device, extent, VK_FORMAT_R32G32B32A32_SFLOAT, write, VK_IMAGE_ASPECT_COLOR_BIT);
  out.readback = create_buffer(device, VkDeviceSize{16} * extent.width * extent.height);
  return out;
}

inline void wait_and_move(VkCommandBuffer cmd, const Image& image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier barrier = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.image = image.image;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.subresourceRange = {image.aspect, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
  vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0,
                       nullptr, 1, &barrier);
}

inline void submit_and_wait(const Device& device) {
  VkSubmitInfo submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &device.cmd;
  need(vkQueueSubmit(device.queue, 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS, 31);
  vkDeviceWaitIdle(device.device);
}

inline void destroy(const Device& device, const Images& images) {
  for (const Image& image : {images.color, images.depth, images.output}) {
    vkDestroyImageView(device.device, image.view, nullptr);
    vkDestroyImage(device.device, image.image, nullptr);
    vkFreeMemory(device.device, image.memory, nullptr);
  }
  vkDestroyBuffer(device.device, images.readback.buffer, nullptr);
  vkFreeMemory(device.device, images.readback.memory, nullptr);
  vkDestroyCommandPool(device.device, device.pool, nullptr);
  vkDestroyDevice(device.device, nullptr);
  vkDestroyInstance(device.instance, nullptr);
}

}  // namespace host
