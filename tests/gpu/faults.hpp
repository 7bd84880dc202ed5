// Failures at a chosen place: the n-th call that creates a Vulkan object or memory, or the n-th `operator new`, which
// faults.cpp replaces in programs that link it. Of the thread that arms them.
#pragma once

#include <cstddef>
#include <functional>

#include "tyndall/effect.hpp"

namespace tyndall::faults {

enum class Kind {
  vulkan,      // calls that create, allocate, bind, map or begin something
  submission,  // submitting a command buffer, and on the fake device ending one
  host,
};

// Lets one call fail: the one after the next `n`. What a Vulkan function does by itself is not counted.
void arm(Kind kind, long n);
// Returns whether a call has failed since.
bool disarm();

// vkGetInstanceProcAddr() of functions that can fail. For one device at a time.
PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance, const char* name);
// Changes what these functions report of the device; an empty function changes nothing.
void set_properties(std::function<void(VkPhysicalDeviceProperties2&)> change);

// A device without a driver: its objects are numbers, its commands do nothing. Fast enough to fail everywhere.
DeviceInfo fake_device();
// vkGetInstanceProcAddr() of that device, for HostDesc.
PFN_vkVoidFunction VKAPI_CALL get_fake_proc_addr(VkInstance instance, const char* name);
// Objects of it that have not been destroyed; pipelines and their layouts apart.
std::size_t live_objects();
std::size_t live_pipeline_objects();
// A number that all commands recorded so far on it determine, with their arguments and with what mapped memory held
// when they were submitted; and back to the first.
std::size_t command_hash();
void forget_commands();

}  // namespace tyndall::faults
