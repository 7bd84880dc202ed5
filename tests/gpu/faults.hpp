// Fault injection: lets the n-th call fail that creates a Vulkan object or memory, or the n-th call of `operator new`,
// which fault_allocations.cpp replaces in programs that link it. Applies to the thread that arms it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "tyndall/effect.hpp"

namespace tyndall::faults {

enum class Kind {
  vulkan,      // calls that create, allocate, bind, map or begin something
  submission,  // submitting a command buffer, and on the fake device ending one
  host,
};

// Lets the call after the next `n` calls fail. Allocations inside Vulkan functions are not counted.
void arm(Kind kind, long n);
// Returns whether a call has failed since arm().
bool disarm();
// Returns whether an allocation on the host must fail, for which the function at this address calls `operator new`.
bool host_allocation_fails(const void* caller);

// A vkGetInstanceProcAddr() whose functions can fail. For one device at a time.
PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance, const char* name);
// Changes the properties that these functions report. An empty function changes nothing.
void set_properties(std::function<void(VkPhysicalDeviceProperties2&)> change);

// Returns a device without a driver: its objects are numbers, and its commands do nothing. It is fast enough to fail at
// every call.
DeviceInfo fake_device();
// The vkGetInstanceProcAddr() of that device, for HostDesc.
PFN_vkVoidFunction VKAPI_CALL get_fake_proc_addr(VkInstance instance, const char* name);
// Lets that device have VK_KHR_portability_subset with some of its features, or not.
struct PortabilitySubset {
  bool comparison_samplers;
  bool events;
};
void set_portability(std::optional<PortabilitySubset> subset);
// Returns the number of its objects that have not been destroyed, without pipelines, their layouts and descriptor
// pools.
std::size_t live_objects();
std::size_t live_pipeline_objects();
// Returns whether one of its buffers, images or other objects exists.
bool is_live(std::uint64_t object);
// Returns a hash of all commands recorded so far, of their arguments, and of mapped memory when they were submitted.
// Then resets the hash.
std::size_t command_hash();
void forget_commands();

}  // namespace tyndall::faults
