// The Vulkan instance and device of our own programs (the library borrows the caller's instead).
// Preference: discrete before integrated before virtual before CPU; among equals the first listed.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gpu/resource.hpp"

namespace tyndall::gpu {

struct DeviceRow {
  std::string name;
  std::string driver;
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  std::uint32_t api_version = 0;
  std::vector<std::string> missing;  // what keeps the device from being used; empty: usable
  bool chosen = false;
};

[[nodiscard]] const char* type_name(VkPhysicalDeviceType type);

struct HostDesc {
  std::string device;       // index, or part of a name (case does not matter); empty: the preferred one
  bool validation = false;  // with synchronisation checks; fails where the layer is not installed
  // Gets every validation message, those about what is left when the device is destroyed included; outlives
  // the Host.
  std::vector<std::string>* validation_log = nullptr;
  // In place of the loader's vkGetInstanceProcAddr, for the functions of Device and of effects on it. Tests pass one
  // whose functions fail.
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  // For programs with a window: what the windowing system needs, and whether a queue family can present there.
  std::vector<const char*> instance_extensions = {};
  std::vector<const char*> device_extensions = {};
  std::function<bool(VkInstance, VkPhysicalDevice, std::uint32_t queue_family)> can_present = {};
};

// Instance, device, one queue with graphics and compute, and the helpers to use it synchronously.
class Host {
 public:
  static Result<std::unique_ptr<Host>> create(const HostDesc& desc);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  // Every device, with what is missing on those that cannot be used; `device` as in HostDesc.
  static Result<std::vector<DeviceRow>> list(const std::string& device = {});

  [[nodiscard]] const Device& device() const { return device_; }
  [[nodiscard]] PFN_vkGetInstanceProcAddr get_instance_proc_addr() const { return get_instance_proc_addr_; }
  [[nodiscard]] std::uint32_t queue_family() const { return queue_family_; }
  // For submissions of the program's own, and for waiting until the device is idle, under the lock.
  [[nodiscard]] VkQueue queue() const { return queue_; }
  [[nodiscard]] std::unique_lock<std::mutex> lock() { return std::unique_lock(queue_mutex_); }
  // See DeviceInfo::replace_shader: for every pipeline made from here on.
  void set_replace_shader(std::span<const std::uint32_t> (*replace)(void* user, std::string_view name), void* user) {
    device_.replace_shader = replace;
    device_.replace_shader_user = user;
  }
  // Returns how many threads the programs create pipelines with; see EffectDesc::pipeline_threads.
  [[nodiscard]] static std::uint32_t pipeline_threads() {
    return std::clamp(std::thread::hardware_concurrency(), 1U, 8U);
  }
  [[nodiscard]] std::string device_name() const { return device_.properties.deviceName; }

  // Records with `record` into a command buffer, submits it and waits until it has completed. From any thread: one
  // after the other. The queue is locked for the submission only.
  Result<void> run(const std::function<Result<void>(VkCommandBuffer)>& record);

  // Messages of the validation layer so far (warnings and errors); the first ones are kept as text.
  [[nodiscard]] std::uint32_t validation_messages() const { return validation_count_; }
  [[nodiscard]] const std::string& validation_text() const { return validation_text_; }

 private:
  Host() = default;
  Result<void> create_instance(bool validation, const std::vector<const char*>& wanted_extensions = {});
  Result<void> create_device(const HostDesc& desc);
  static VkBool32 VKAPI_PTR on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                       VkDebugUtilsMessageTypeFlagsEXT types,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void* user);

  std::mutex queue_mutex_, run_mutex_;  // of the queue, and of what run() uses
  VkInstance instance_ = VK_NULL_HANDLE;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr_ = vkGetInstanceProcAddr;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  Device device_;
  VkQueue queue_ = VK_NULL_HANDLE;
  std::uint32_t queue_family_ = 0;
  Handle<VkCommandPool> pool_;
  VkCommandBuffer cmd_ = VK_NULL_HANDLE;
  Handle<VkFence> fence_;
  std::mutex message_mutex_;  // messages come from the thread that called
  std::atomic<std::uint32_t> validation_count_ = 0;
  std::string validation_text_;
  std::vector<std::string>* validation_log_ = nullptr;
};

// Copies bytes to a device-local buffer, or into every layer of an image that is then left in `layout`.
Result<void> upload(Host& host, const Buffer& to, const void* data, VkDeviceSize size);
Result<void> upload(Host& host, const Image& to, const void* data, VkDeviceSize size, VkImageLayout layout);
// Copies the first level of one layer of an image in `layout` to the host, rows tightly packed.
Result<std::vector<std::byte>> download(Host& host, const Image& from, VkImageLayout layout, std::uint32_t layer,
                                        std::uint32_t bytes_per_texel);
Result<std::vector<std::byte>> download(Host& host, const Buffer& from, VkDeviceSize size);

}  // namespace tyndall::gpu
