#include "gpu/open_device.hpp"

namespace tyndall::gpu {

Result<void> open_device(Device& device, const DeviceInfo& info) {
  device.instance = info.instance;
  device.physical_device = info.physical_device;
  device.device = info.device;
  device.allocator = info.allocator;
  device.pipeline_cache = info.pipeline_cache;
  device.replace_shader = info.replace_shader;
  device.replace_shader_user = info.replace_shader_user;
  device.memory_callbacks = info.memory;
  return init_device(device, info.get_instance_proc_addr);
}

}  // namespace tyndall::gpu
