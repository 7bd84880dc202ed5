#include "gpu/device.hpp"

#include <string>

namespace tyndall::gpu {

Error vulkan_error(VkResult result, const char* what, const char* name) {
  Error error;
  error.vk_result = static_cast<std::int32_t>(result);
  const char* reason = "an unexpected error of the driver";
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      error.code = ErrorCode::out_of_memory;
      reason = "out of host memory";
      break;
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      error.code = ErrorCode::out_of_memory;
      reason = "out of device memory";
      break;
    case VK_ERROR_DEVICE_LOST:
      error.code = ErrorCode::device_lost;
      reason = "the device is lost";
      break;
    case VK_ERROR_INITIALIZATION_FAILED:
      error.code = ErrorCode::vulkan;
      reason = "initialisation failed";
      break;
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
    case VK_ERROR_FEATURE_NOT_PRESENT:
    case VK_ERROR_EXTENSION_NOT_PRESENT:
      error.code = ErrorCode::unsupported_device;
      reason = "the device does not support it";
      break;
    default: error.code = ErrorCode::vulkan; break;
  }
  error.message = std::string(what) + " of " + name + " failed: " + reason + " (VkResult " +
                  std::to_string(static_cast<int>(result)) + ")";
  return error;
}

Result<void> init_device(Device& device, PFN_vkGetInstanceProcAddr get) {
  if (const char* missing = load_functions(device.vk, get, device.instance, device.device)) {
    return Error{ErrorCode::unsupported_device,
                 std::string("the Vulkan device lacks ") + missing + "; expected Vulkan 1.3"};
  }
  VkPhysicalDeviceMaintenance4Properties buffers = {};
  buffers.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES;
  VkPhysicalDeviceMaintenance3Properties allocations = {};
  allocations.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
  allocations.pNext = &buffers;
  VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &allocations, {}};
  device.vk.GetPhysicalDeviceProperties2(device.physical_device, &properties);
  device.properties = properties.properties;
  device.max_buffer_bytes = buffers.maxBufferSize;
  device.max_allocation_bytes = allocations.maxMemoryAllocationSize;
  device.vk.GetPhysicalDeviceMemoryProperties(device.physical_device, &device.memory);
  return {};
}

std::uint32_t find_memory_type(const Device& device, std::uint32_t bits, VkMemoryPropertyFlags flags) {
  for (std::uint32_t i = 0; i < device.memory.memoryTypeCount; ++i) {
    if ((bits & (1U << i)) != 0 && (device.memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
  }
  return VK_MAX_MEMORY_TYPES;
}

#define TYNDALL_DESTROY(type, function) \
  void destroy(const Device& device, type handle) { device.vk.function(device.device, handle, device.allocator); }
TYNDALL_DESTROY(VkBuffer, DestroyBuffer)
TYNDALL_DESTROY(VkImage, DestroyImage)
TYNDALL_DESTROY(VkImageView, DestroyImageView)
TYNDALL_DESTROY(VkPipeline, DestroyPipeline)
TYNDALL_DESTROY(VkPipelineCache, DestroyPipelineCache)
TYNDALL_DESTROY(VkPipelineLayout, DestroyPipelineLayout)
TYNDALL_DESTROY(VkDescriptorSetLayout, DestroyDescriptorSetLayout)
TYNDALL_DESTROY(VkDescriptorPool, DestroyDescriptorPool)
TYNDALL_DESTROY(VkSampler, DestroySampler)
TYNDALL_DESTROY(VkQueryPool, DestroyQueryPool)
TYNDALL_DESTROY(VkCommandPool, DestroyCommandPool)
TYNDALL_DESTROY(VkFence, DestroyFence)
TYNDALL_DESTROY(VkEvent, DestroyEvent)
TYNDALL_DESTROY(VkShaderModule, DestroyShaderModule)
#undef TYNDALL_DESTROY

void set_name(const Device& device, VkObjectType type, std::uint64_t handle, const char* name) {
  if (device.vk.SetDebugUtilsObjectNameEXT == nullptr) return;
  VkDebugUtilsObjectNameInfoEXT info = {VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, type, handle,
                                        name};
  device.vk.SetDebugUtilsObjectNameEXT(device.device, &info);
}

Label::Label(const Device& device, VkCommandBuffer cmd, const char* name) : device_(device), cmd_(cmd) {
  if (device_.vk.CmdBeginDebugUtilsLabelEXT == nullptr) return;
  VkDebugUtilsLabelEXT label = {};
  label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
  label.pLabelName = name;
  device_.vk.CmdBeginDebugUtilsLabelEXT(cmd_, &label);
}

Label::~Label() {
  if (device_.vk.CmdEndDebugUtilsLabelEXT != nullptr) device_.vk.CmdEndDebugUtilsLabelEXT(cmd_);
}

void barrier(const Device& device, VkCommandBuffer cmd, VkPipelineStageFlags from, VkAccessFlags from_access,
             VkPipelineStageFlags to, VkAccessFlags to_access) {
  const VkMemoryBarrier memory = {VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, from_access, to_access};
  device.vk.CmdPipelineBarrier(cmd, from, to, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

void compute_barrier(const Device& device, VkCommandBuffer cmd) {
  barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
          VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT);
}

}  // namespace tyndall::gpu
