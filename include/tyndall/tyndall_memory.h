// The part of the C interface for device memory from the program's allocator; see memory.hpp. tyndall.h includes it.
#ifndef TYNDALL_TYNDALL_MEMORY_H
#define TYNDALL_TYNDALL_MEMORY_H

#include <vulkan/vulkan.h>

// These structures never grow.
typedef struct TyndallMemoryRequest {
  const char* name;
  VkImage image;  // null for a buffer
  VkBuffer buffer;
  VkMemoryRequirements requirements;
  VkFlags usage;
  VkMemoryPropertyFlags needed;
  VkMemoryPropertyFlags preferred;
} TyndallMemoryRequest;

typedef struct TyndallMemoryBlock {
  VkDeviceMemory memory;
  VkDeviceSize offset;
  void* mapped;
  void* user;
} TyndallMemoryBlock;

#endif
