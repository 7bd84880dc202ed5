// A Vulkan layer that hides graphics and timestamps of all queues, so that a device looks like one that only computes.
// The validation layer above it then reports commands that need more.
#include <vulkan/vk_layer.h>

#include <cstdint>
#include <cstring>

namespace {

// The functions below this layer. They are the same for all instances, and for all devices.
PFN_vkGetInstanceProcAddr next_instance = nullptr;
PFN_vkGetDeviceProcAddr next_device = nullptr;
PFN_vkGetPhysicalDeviceQueueFamilyProperties next_families = nullptr;
PFN_vkGetPhysicalDeviceQueueFamilyProperties2 next_families2 = nullptr;
VkInstance last_instance = VK_NULL_HANDLE;

template <typename Function>
Function cast(PFN_vkVoidFunction function) {
  return reinterpret_cast<Function>(function);
}

void hide(VkQueueFamilyProperties& family) {
  family.queueFlags &= ~static_cast<VkQueueFlags>(VK_QUEUE_GRAPHICS_BIT);
  family.timestampValidBits = 0;
}

VKAPI_ATTR void VKAPI_CALL families(VkPhysicalDevice device, std::uint32_t* count, VkQueueFamilyProperties* out) {
  next_families(device, count, out);
  for (std::uint32_t i = 0; out != nullptr && i < *count; ++i) hide(out[i]);
}

VKAPI_ATTR void VKAPI_CALL families2(VkPhysicalDevice device, std::uint32_t* count, VkQueueFamilyProperties2* out) {
  next_families2(device, count, out);
  for (std::uint32_t i = 0; out != nullptr && i < *count; ++i) hide(out[i].queueFamilyProperties);
}

// Returns the link to the next layer, which the loader appends to the structures that create instances and devices.
template <typename Link>
Link* link_of(const void* next, VkStructureType type) {
  for (auto* at = static_cast<const VkBaseInStructure*>(next); at != nullptr; at = at->pNext) {
    auto* const link = reinterpret_cast<Link*>(const_cast<VkBaseInStructure*>(at));
    if (at->sType == type && link->function == VK_LAYER_LINK_INFO) return link;
  }
  return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* out) {
  auto* const link = link_of<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  next_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = cast<PFN_vkCreateInstance>(next_instance(VK_NULL_HANDLE, "vkCreateInstance"));
  const VkResult result = create(info, allocator, out);
  if (result != VK_SUCCESS) return result;
  last_instance = *out;
  next_families = cast<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(
      next_instance(*out, "vkGetPhysicalDeviceQueueFamilyProperties"));
  next_families2 = cast<PFN_vkGetPhysicalDeviceQueueFamilyProperties2>(
      next_instance(*out, "vkGetPhysicalDeviceQueueFamilyProperties2"));
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice device, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* out) {
  auto* const link = link_of<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  const PFN_vkGetInstanceProcAddr get = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  next_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  return cast<PFN_vkCreateDevice>(get(last_instance, "vkCreateDevice"))(device, info, allocator, out);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_proc(VkDevice device, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(device_proc);
  return next_device(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_proc(VkInstance instance, const char* name) {
  const struct {
    const char* name;
    PFN_vkVoidFunction function;
  } own[] = {
      {"vkGetInstanceProcAddr", reinterpret_cast<PFN_vkVoidFunction>(instance_proc)},
      {"vkGetDeviceProcAddr", reinterpret_cast<PFN_vkVoidFunction>(device_proc)},
      {"vkCreateInstance", reinterpret_cast<PFN_vkVoidFunction>(create_instance)},
      {"vkCreateDevice", reinterpret_cast<PFN_vkVoidFunction>(create_device)},
      {"vkGetPhysicalDeviceQueueFamilyProperties", reinterpret_cast<PFN_vkVoidFunction>(families)},
      {"vkGetPhysicalDeviceQueueFamilyProperties2", reinterpret_cast<PFN_vkVoidFunction>(families2)},
  };
  for (const auto& row : own) {
    if (std::strcmp(name, row.name) == 0) return row.function;
  }
  return next_instance != nullptr ? next_instance(instance, name) : nullptr;
}

}  // namespace

extern "C" VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* negotiated) {
  negotiated->loaderLayerInterfaceVersion = 2;
  negotiated->pfnGetInstanceProcAddr = instance_proc;
  negotiated->pfnGetDeviceProcAddr = device_proc;
  negotiated->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
