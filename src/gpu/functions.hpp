// The Vulkan functions in use, as a table per device. There is no global state and no link to a loader, so the library
// works with a device from any loader.
#pragma once

#include <vulkan/vulkan.h>

namespace tyndall::gpu {

#define TYNDALL_INSTANCE_FUNCTIONS(X)   \
  X(EnumerateDeviceExtensionProperties) \
  X(GetDeviceProcAddr)                  \
  X(GetPhysicalDeviceFeatures2)         \
  X(GetPhysicalDeviceProperties2)       \
  X(GetPhysicalDeviceMemoryProperties)  \
  X(GetPhysicalDeviceFormatProperties)

#define TYNDALL_DEVICE_FUNCTIONS(X)    \
  X(AllocateCommandBuffers)            \
  X(AllocateDescriptorSets)            \
  X(AllocateMemory)                    \
  X(BeginCommandBuffer)                \
  X(BindBufferMemory)                  \
  X(BindImageMemory)                   \
  X(CmdBeginRendering)                 \
  X(CmdBindDescriptorSets)             \
  X(CmdBindIndexBuffer)                \
  X(CmdBindPipeline)                   \
  X(CmdClearColorImage)                \
  X(CmdCopyBuffer)                     \
  X(CmdCopyBufferToImage)              \
  X(CmdCopyImageToBuffer)              \
  X(CmdDispatch)                       \
  X(CmdDispatchIndirect)               \
  X(CmdDraw)                           \
  X(CmdDrawIndexed)                    \
  X(CmdEndRendering)                   \
  X(CmdFillBuffer)                     \
  X(CmdPipelineBarrier)                \
  X(CmdPushConstants)                  \
  X(CmdResetQueryPool)                 \
  X(CmdSetEvent)                       \
  X(CmdSetScissor)                     \
  X(CmdSetViewport)                    \
  X(CmdUpdateBuffer)                   \
  X(CmdWriteTimestamp)                 \
  X(CreateBuffer)                      \
  X(CreateCommandPool)                 \
  X(CreateComputePipelines)            \
  X(CreateDescriptorPool)              \
  X(CreateDescriptorSetLayout)         \
  X(CreateEvent)                       \
  X(CreateFence)                       \
  X(CreateGraphicsPipelines)           \
  X(CreateImage)                       \
  X(CreateImageView)                   \
  X(CreatePipelineCache)               \
  X(CreatePipelineLayout)              \
  X(CreateQueryPool)                   \
  X(CreateSampler)                     \
  X(CreateShaderModule)                \
  X(DestroyBuffer)                     \
  X(DestroyCommandPool)                \
  X(DestroyDescriptorPool)             \
  X(DestroyDescriptorSetLayout)        \
  X(DestroyEvent)                      \
  X(DestroyFence)                      \
  X(DestroyImage)                      \
  X(DestroyImageView)                  \
  X(DestroyPipeline)                   \
  X(DestroyPipelineCache)              \
  X(DestroyPipelineLayout)             \
  X(DestroyQueryPool)                  \
  X(DestroySampler)                    \
  X(DestroyShaderModule)               \
  X(DeviceWaitIdle)                    \
  X(EndCommandBuffer)                  \
  X(FreeMemory)                        \
  X(GetBufferMemoryRequirements)       \
  X(GetDeviceBufferMemoryRequirements) \
  X(GetDeviceImageMemoryRequirements)  \
  X(GetEventStatus)                    \
  X(GetImageMemoryRequirements)        \
  X(GetPipelineCacheData)              \
  X(GetQueryPoolResults)               \
  X(MapMemory)                         \
  X(QueueSubmit)                       \
  X(ResetDescriptorPool)               \
  X(ResetEvent)                        \
  X(ResetFences)                       \
  X(UpdateDescriptorSets)              \
  X(WaitForFences)

// These are null unless the instance has VK_EXT_debug_utils.
#define TYNDALL_DEBUG_FUNCTIONS(X) \
  X(CmdBeginDebugUtilsLabelEXT)    \
  X(CmdEndDebugUtilsLabelEXT)      \
  X(SetDebugUtilsObjectNameEXT)

struct Functions {
#define X(name) PFN_vk##name name = nullptr;
  TYNDALL_INSTANCE_FUNCTIONS(X)
  TYNDALL_DEVICE_FUNCTIONS(X)
  TYNDALL_DEBUG_FUNCTIONS(X)
#undef X
};

// Fills in the table. Returns the name of the first function that the device lacks, or nullptr.
const char* load_functions(Functions& table, PFN_vkGetInstanceProcAddr get, VkInstance instance, VkDevice device);

}  // namespace tyndall::gpu
