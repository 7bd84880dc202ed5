// The Vulkan instance and device of our own programs. (The library borrows those of its caller.) Discrete GPUs are
// preferred to integrated, virtual and CPU devices, in this order. Among devices of one type, the first is used.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gpu/descriptors.hpp"
#include "gpu/resource.hpp"

namespace tyndall::gpu {

struct DeviceRow {
  std::string name;
  std::string driver;
  VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
  std::uint32_t api_version = 0;
  std::vector<std::string> missing;  // required features that the device lacks; empty: usable
  bool graphics = false;             // has a queue for drawing, besides computing; see HostDesc::graphics
  bool chosen = false;
};

[[nodiscard]] const char* type_name(VkPhysicalDeviceType type);

struct HostDesc {
  std::string device;       // an index, or a part of a name in any case; empty: the preferred device
  bool validation = false;  // with synchronisation checks; create() fails if the layer is not installed
  // Receives every validation message, including those about objects that are leaked when the device is destroyed. It
  // must outlive the Host.
  std::vector<std::string>* validation_log = nullptr;
  // Used instead of the loader's vkGetInstanceProcAddr for the function table. Tests inject failing functions with it.
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  // For programs with a window: the extensions that the windowing system requires, and a function that returns whether
  // a queue family can present to the window.
  std::vector<const char*> instance_extensions = {};
  std::vector<const char*> device_extensions = {};
  std::function<bool(VkInstance, VkPhysicalDevice, std::uint32_t queue_family)> can_present = {};
  bool graphics = true;      // false: the program only computes, and a queue without graphics suffices
  std::uint32_t queues = 1;  // number of queues to create in the family; fewer if the family has fewer
};

// Owns an instance, a device and a queue. The queue supports compute and, if HostDesc::graphics is set, graphics.
class Host {
 public:
  static Result<std::unique_ptr<Host>> create(const HostDesc& desc);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  // Returns all devices, with the features that each one lacks. `device` is HostDesc::device.
  static Result<std::vector<DeviceRow>> list(const std::string& device = {});

  [[nodiscard]] const Device& device() const { return device_; }
  [[nodiscard]] PFN_vkGetInstanceProcAddr get_instance_proc_addr() const { return get_instance_proc_addr_; }
  [[nodiscard]] std::uint32_t queue_family() const { return queue_family_; }
  // Returns whether the queue has timestamps, which EffectDesc::timings and Timer need.
  [[nodiscard]] bool timestamps() const { return timestamps_; }
  // The caller must hold lock() while it submits to the queue or waits until the device is idle.
  // The functions below use the first queue, which is also returned for an index beyond the created queues.
  [[nodiscard]] VkQueue queue(std::size_t index = 0) const { return queues_[index < queues_.size() ? index : 0]; }
  [[nodiscard]] std::unique_lock<std::mutex> lock() { return std::unique_lock(queue_mutex_); }
  // Sets DeviceInfo::replace_shader for all pipelines created afterwards.
  void set_replace_shader(std::span<const std::uint32_t> (*replace)(void* user, std::string_view name), void* user) {
    device_.replace_shader = replace;
    device_.replace_shader_user = user;
  }
  // Sets the cache for all pipelines created afterwards; null for none. It must outlive its use here and all effects
  // that were created with it.
  void set_pipeline_cache(VkPipelineCache cache) { device_.pipeline_cache = cache; }
  // Returns how many threads the programs create pipelines with; see EffectDesc::pipeline_threads.
  [[nodiscard]] static std::uint32_t pipeline_threads() {
    return std::clamp(std::thread::hardware_concurrency(), 1U, 8U);
  }
  [[nodiscard]] std::string device_name() const { return device_.properties.deviceName; }

  using Record = std::function<Result<void>(VkCommandBuffer)>;
  // Records a command buffer with `record`, submits it and waits until it and all earlier ones have completed. May be
  // called from any thread; concurrent calls run one after the other. The queue is locked only during submission.
  Result<void> run(const Record& record);
  // Records and submits a command buffer without waiting for it. If kPending earlier ones have not been waited for,
  // waits for the oldest of them first. Returns the number of the submission, for wait().
  Result<std::uint64_t> submit(const Record& record);
  static constexpr std::size_t kPending = 8;
  // Waits until a submission and all earlier ones have completed. Does nothing for the number 0.
  Result<void> wait(std::uint64_t submission);
  // Waits until all submissions have completed, whoever made them.
  Result<void> wait_for_all();
  // Waits until the device is idle.
  void wait_idle();
  // The descriptor sets of the command buffer that is being recorded, to be used only while `record` runs.
  [[nodiscard]] DescriptorArena& sets() { return slots_[recording_].sets; }

  // The number of warnings and errors of the validation layer so far. The text of the first ones is stored.
  [[nodiscard]] std::uint32_t validation_messages() const { return validation_count_; }
  [[nodiscard]] const std::string& validation_text() const { return validation_text_; }

 private:
  Host() = default;
  Result<void> create_instance(bool validation, const std::vector<const char*>& wanted_extensions = {});
  Result<void> create_device(const HostDesc& desc);
  static VkBool32 VKAPI_PTR on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                       VkDebugUtilsMessageTypeFlagsEXT types,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void* user);

  // A command buffer with what it needs while it executes.
  struct Slot {
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    Handle<VkFence> fence;
    DescriptorArena sets;
    std::uint64_t submission = 0;  // 0: none, or it has been waited for
  };
  // These need run_mutex_.
  Result<std::uint64_t> record_and_submit(const Record& record);
  Result<void> wait_for(Slot& slot);
  // Returns the slot of a submission, or nullptr if it has been waited for.
  [[nodiscard]] Slot* pending(std::uint64_t submission);

  std::mutex queue_mutex_, run_mutex_;  // run_mutex_ guards the slots
  VkInstance instance_ = VK_NULL_HANDLE;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr_ = vkGetInstanceProcAddr;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  Device device_;
  std::vector<VkQueue> queues_;
  std::uint32_t queue_family_ = 0;
  bool timestamps_ = false;
  Handle<VkCommandPool> pool_;
  std::array<Slot, kPending> slots_;
  std::size_t recording_ = 0;      // index of the slot that is being recorded
  std::uint64_t submissions_ = 0;  // the number of the last one
  std::mutex message_mutex_;       // messages arrive on the thread that made the Vulkan call
  std::atomic<std::uint32_t> validation_count_ = 0;
  std::string validation_text_;
  std::vector<std::string>* validation_log_ = nullptr;
};

// Copies bytes to a device-local buffer, or to all layers of an image, which then has the layout `layout`.
Result<void> upload(Host& host, const Buffer& to, const void* data, VkDeviceSize size);
Result<void> upload(Host& host, const Image& to, const void* data, VkDeviceSize size, VkImageLayout layout);
// Copies the first level of one layer of an image to the host, with tightly packed rows. `layout`: of the image.
Result<std::vector<std::byte>> download(Host& host, const Image& from, VkImageLayout layout, std::uint32_t layer,
                                        std::uint32_t bytes_per_texel);
Result<std::vector<std::byte>> download(Host& host, const Buffer& from, VkDeviceSize size);

}  // namespace tyndall::gpu
