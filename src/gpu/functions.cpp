#include "gpu/functions.hpp"

namespace tyndall::gpu {

const char* load_functions(Functions& table, PFN_vkGetInstanceProcAddr get, VkInstance instance, VkDevice device) {
  const char* missing = nullptr;
#define X(name)                                                           \
  table.name = reinterpret_cast<PFN_vk##name>(get(instance, "vk" #name)); \
  if (table.name == nullptr && missing == nullptr) missing = "vk" #name;
  TYNDALL_INSTANCE_FUNCTIONS(X)
#undef X
  if (missing != nullptr) return missing;
#define X(name)                                                                             \
  table.name = reinterpret_cast<PFN_vk##name>(table.GetDeviceProcAddr(device, "vk" #name)); \
  if (table.name == nullptr && missing == nullptr) missing = "vk" #name;
  TYNDALL_DEVICE_FUNCTIONS(X)
#undef X
#define X(name) table.name = reinterpret_cast<PFN_vk##name>(table.GetDeviceProcAddr(device, "vk" #name));
  TYNDALL_DEBUG_FUNCTIONS(X)
#undef X
  return missing;
}

}  // namespace tyndall::gpu
