// A borrowed Vulkan device with its function table, and handles that own objects of this device. The device itself is
// created and destroyed by the caller (in our own programs by src/gpu/host.hpp). A Device must not move and must
// outlive every object created with it. It is used by one thread at a time.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>

#include "gpu/functions.hpp"
#include "tyndall/memory.hpp"
#include "tyndall/result.hpp"

namespace tyndall::gpu {

struct Device {
  Functions vk;
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  const VkAllocationCallbacks* allocator = nullptr;
  VkPipelineCache pipeline_cache = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties = {};
  VkDeviceSize max_buffer_bytes = 0;
  VkDeviceSize max_allocation_bytes = 0;
  VkPhysicalDeviceMemoryProperties memory = {};
  // Returns SPIR-V to use instead of the built-in shader of that name, or an empty span (DeviceInfo::replace_shader).
  std::span<const std::uint32_t> (*replace_shader)(void* user, std::string_view name) = nullptr;
  void* replace_shader_user = nullptr;
  MemoryCallbacks memory_callbacks;  // DeviceInfo::memory
};

// Returns the error for a VkResult. The message reads: `what` of `name` failed.
[[nodiscard]] Error vulkan_error(VkResult result, const char* what, const char* name);

// Fills in the function table, the properties and the memory types. Fails if the device lacks a function.
Result<void> init_device(Device& device, PFN_vkGetInstanceProcAddr get);

// Returns the index of a memory type of `bits` with all of `flags`, or VK_MAX_MEMORY_TYPES if there is none.
[[nodiscard]] std::uint32_t find_memory_type(const Device& device, std::uint32_t bits, VkMemoryPropertyFlags flags);

void destroy(const Device& device, VkBuffer handle);
void destroy(const Device& device, VkImage handle);
void destroy(const Device& device, VkImageView handle);
void destroy(const Device& device, VkPipeline handle);
void destroy(const Device& device, VkPipelineCache handle);
void destroy(const Device& device, VkPipelineLayout handle);
void destroy(const Device& device, VkDescriptorSetLayout handle);
void destroy(const Device& device, VkDescriptorPool handle);
void destroy(const Device& device, VkSampler handle);
void destroy(const Device& device, VkQueryPool handle);
void destroy(const Device& device, VkCommandPool handle);
void destroy(const Device& device, VkFence handle);
void destroy(const Device& device, VkEvent handle);
void destroy(const Device& device, VkShaderModule handle);

// Move-only owner of one Vulkan object.
template <typename T>
class Handle {
 public:
  Handle() = default;
  Handle(const Device& device, T value) : device_(&device), value_(value) {}
  Handle(Handle&& other) noexcept
      : device_(std::exchange(other.device_, nullptr)), value_(std::exchange(other.value_, T{})) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      device_ = std::exchange(other.device_, nullptr);
      value_ = std::exchange(other.value_, T{});
    }
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { reset(); }

  void reset() {
    if (device_ != nullptr && value_ != T{}) destroy(*device_, value_);
    value_ = T{};
  }
  [[nodiscard]] T get() const { return value_; }
  explicit operator bool() const { return value_ != T{}; }

 private:
  const Device* device_ = nullptr;
  T value_ = T{};
};

// Names an object for validation messages and captures. Does nothing without VK_EXT_debug_utils.
void set_name(const Device& device, VkObjectType type, std::uint64_t handle, const char* name);
template <typename T>
void set_name(const Device& device, VkObjectType type, T handle, const char* name) {
  set_name(device, type, reinterpret_cast<std::uint64_t>(handle), name);
}

// Labels the commands that are recorded during its lifetime.
class Label {
 public:
  Label(const Device& device, VkCommandBuffer cmd, const char* name);
  ~Label();
  Label(const Label&) = delete;
  Label& operator=(const Label&) = delete;

 private:
  const Device& device_;
  VkCommandBuffer cmd_;
};

// Records a global memory barrier. All passes use this form, without barriers of single images and buffers.
void barrier(const Device& device, VkCommandBuffer cmd, VkPipelineStageFlags from, VkAccessFlags from_access,
             VkPipelineStageFlags to, VkAccessFlags to_access);
// Records a barrier that makes the writes of compute shaders visible to reads and writes of later ones.
void compute_barrier(const Device& device, VkCommandBuffer cmd);

}  // namespace tyndall::gpu
