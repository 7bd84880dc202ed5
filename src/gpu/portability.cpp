#include "gpu/portability.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace tyndall::gpu {

std::vector<const char*> Portability::missing() const {
  std::vector<const char*> out;
  if (!subset) return out;
  if (features.mutableComparisonSamplers == VK_FALSE) out.push_back("mutableComparisonSamplers");
  if (features.events == VK_FALSE) out.push_back("events");
  return out;
}

Portability portability_of(VkPhysicalDevice device, PFN_vkEnumerateDeviceExtensionProperties extensions,
                           PFN_vkGetPhysicalDeviceFeatures2 features) {
  Portability out;
  std::uint32_t count = 0;
  extensions(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> list(count);
  if (count > 0) extensions(device, nullptr, &count, list.data());
  out.subset = std::any_of(list.begin(), list.begin() + count, [](const VkExtensionProperties& e) {
    return std::strcmp(e.extensionName, VK_KHR_PORTABILITY_SUBSET_EXTENSION_NAME) == 0;
  });
  if (!out.subset) return out;
  out.features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PORTABILITY_SUBSET_FEATURES_KHR;
  VkPhysicalDeviceFeatures2 query = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &out.features, {}};
  features(device, &query);
  out.features.pNext = nullptr;
  return out;
}

}  // namespace tyndall::gpu
