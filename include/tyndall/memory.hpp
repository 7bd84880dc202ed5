// Device memory from the allocator of an engine, in place of vkAllocateMemory().
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>

namespace tyndall {

// An image or a buffer that needs memory. It has been created, and is bound to the memory after the call.
struct MemoryRequest {
  const char* name = "";           // as in Effect::resources(); valid during the call
  VkImage image = VK_NULL_HANDLE;  // null for a buffer
  VkBuffer buffer = VK_NULL_HANDLE;
  VkFlags usage = 0;  // VkImageUsageFlags or VkBufferUsageFlags
  VkMemoryRequirements requirements = {};
  VkMemoryPropertyFlags needed = 0;     // properties that the memory type must have
  VkMemoryPropertyFlags preferred = 0;  // properties that it should have, if there is such a type; include `needed`
};

// A part of device memory.
struct MemoryBlock {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;  // a multiple of MemoryRequest::requirements.alignment
  // The address of the part on the host, which stays mapped. Needed if MemoryRequest::needed contains HOST_VISIBLE.
  void* mapped = nullptr;
  void* user = nullptr;  // not used by the effect
};

// Callbacks for device memory. Set both functions or neither. The library calls them in the thread that called it.
// Record functions never allocate, but Effect::record() may free memory that no frame in flight uses. The callbacks
// must not throw, and must not call the object that called them.
struct MemoryCallbacks {
  // Fills in `block` with at least requirements.size bytes, and returns VK_SUCCESS. Any other result is answered with
  // ErrorCode::out_of_memory by the call that needed the memory, which then has changed nothing.
  VkResult (*allocate)(void* user, const MemoryRequest& request, MemoryBlock& block) = nullptr;
  // Frees a block, after its image or buffer has been destroyed. `bytes` is the requirements.size of its request.
  void (*free)(void* user, const MemoryBlock& block, VkDeviceSize bytes) = nullptr;
  void* user = nullptr;
};

}  // namespace tyndall
