// Lets all effects of a test program share their compute pipelines, because compiling them takes most of the time of
// many tests. A pipeline is compiled once for each shader and each set of constants, and lives as long as the device.
#pragma once

#include <vulkan/vulkan.h>

#include <cstddef>

namespace tyndall::shared_pipelines {

// A vkGetInstanceProcAddr(), for gpu::HostDesc and DeviceInfo. For one device at a time.
PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance, const char* name);

// Destroys the shared pipelines. To be called before the device is destroyed. Returns the number of pipelines that
// their users have not destroyed.
std::size_t release();

}  // namespace tyndall::shared_pipelines
