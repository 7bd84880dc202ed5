// Drivers that implement Vulkan on top of another graphics API, such as MoltenVK, support a subset of Vulkan. They have
// the extension VK_KHR_portability_subset, and its features say what they support.
#pragma once

#include <vulkan/vulkan.h>

#include <vector>

namespace tyndall::gpu {

struct Portability {
  bool subset = false;  // the device has the extension, so that it must be enabled
  VkPhysicalDevicePortabilitySubsetFeaturesKHR features = {};

  // Returns the features of the subset that Tyndall needs and the device lacks.
  [[nodiscard]] std::vector<const char*> missing() const;
};
[[nodiscard]] Portability portability_of(VkPhysicalDevice device, PFN_vkEnumerateDeviceExtensionProperties extensions,
                                         PFN_vkGetPhysicalDeviceFeatures2 features);

}  // namespace tyndall::gpu
