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
  // The loader returns these for an instance only if the extension is enabled. For a device, the validation layer
  // returns them in any case, and then reports each call.
#define X(name)                                                                             \
  table.name = reinterpret_cast<PFN_vk##name>(table.GetDeviceProcAddr(device, "vk" #name)); \
  if (get(instance, "vk" #name) == nullptr) table.name = nullptr;
  TYNDALL_DEBUG_FUNCTIONS(X)
#undef X
  return missing;
}

}  // namespace tyndall::gpu
