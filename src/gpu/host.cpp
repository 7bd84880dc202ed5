#include "gpu/host.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>

#include "gpu/portability.hpp"
#include "gpu/try.hpp"

namespace tyndall::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* kGraphics = "a queue with graphics";

int rank(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return 3;
    default: return 4;
  }
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

struct QueueFamily {
  std::uint32_t index = UINT32_MAX;
  bool graphics = false;
  bool timestamps = false;
  std::uint32_t queues = 0;
};

// Returns the best queue family with compute: one with graphics if there is one, and then one with timestamps.
QueueFamily find_queue_family(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  QueueFamily best;
  for (std::uint32_t i = 0; i < count; ++i) {
    if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) continue;
    const QueueFamily family = {i, (families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0,
                                families[i].timestampValidBits > 0, families[i].queueCount};
    const auto rank = [](const QueueFamily& f) { return (f.graphics ? 2 : 0) + (f.timestamps ? 1 : 0); };
    if (best.index == UINT32_MAX || rank(family) > rank(best)) best = family;
  }
  return best;
}

bool has_extension(VkPhysicalDevice device, const char* name) {
  std::uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

Portability portability_of(VkPhysicalDevice device) {
  return gpu::portability_of(device, vkEnumerateDeviceExtensionProperties, vkGetPhysicalDeviceFeatures2);
}

DeviceRow describe(VkPhysicalDevice device) {
  VkPhysicalDeviceDriverProperties driver = {};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver, {}};
  vkGetPhysicalDeviceProperties2(device, &properties);
  DeviceRow row;
  row.name = properties.properties.deviceName;
  row.driver = std::string(driver.driverName) + " " + driver.driverInfo;
  row.type = properties.properties.deviceType;
  row.api_version = properties.properties.apiVersion;
  if (row.api_version < VK_API_VERSION_1_3) row.missing.emplace_back("Vulkan 1.3");
  const QueueFamily family = find_queue_family(device);
  row.graphics = family.graphics;
  if (family.index == UINT32_MAX) row.missing.emplace_back("a queue with compute");
  for (const char* feature : portability_of(device).missing()) row.missing.emplace_back(feature);
  return row;
}

Result<std::vector<VkPhysicalDevice>> enumerate(VkInstance instance) {
  std::uint32_t count = 0;
  VkResult result = vkEnumeratePhysicalDevices(instance, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  if (result == VK_SUCCESS) result = vkEnumeratePhysicalDevices(instance, &count, devices.data());
  if (result == VK_ERROR_INITIALIZATION_FAILED)
    count = 0;
  else if (result != VK_SUCCESS && result != VK_INCOMPLETE) {
    return vulkan_error(result, "enumerating", "the Vulkan devices");
  }
  devices.resize(count);
  return devices;
}

// Returns the index of the device to use. `wanted` is HostDesc::device.
Result<std::size_t> choose(const std::vector<DeviceRow>& rows, const std::string& wanted) {
  if (rows.empty()) {
    return Error{ErrorCode::unsupported_device,
                 "no Vulkan device on this machine; expected a driver (without a GPU: Debian's mesa-vulkan-drivers)"};
  }
  std::size_t best = rows.size();
  if (!wanted.empty()) {
    const bool index = std::all_of(wanted.begin(), wanted.end(), [](unsigned char c) { return std::isdigit(c); });
    for (std::size_t i = 0; i < rows.size() && best == rows.size(); ++i) {
      if (index ? std::to_string(i) == wanted : lower(rows[i].name).find(lower(wanted)) != std::string::npos) best = i;
    }
    if (best == rows.size()) {
      std::string names;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        names += (i > 0 ? ", " : "") + std::to_string(i) + " = " + rows[i].name;
      }
      return Error{ErrorCode::invalid_argument,
                   "--device: no Vulkan device '" + wanted + "'; expected an index or a part of a name: " + names};
    }
  } else {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!rows[i].missing.empty()) continue;
      if (best == rows.size() || rank(rows[i].type) < rank(rows[best].type)) best = i;
    }
    if (best == rows.size()) best = 0;
  }
  if (!rows[best].missing.empty()) {
    std::string missing;
    for (const std::string& m : rows[best].missing) missing += (missing.empty() ? "" : ", ") + m;
    return Error{ErrorCode::unsupported_device,
                 "the Vulkan device '" + rows[best].name + "' cannot be used; expected " + missing};
  }
  return best;
}

bool has_instance_extension(const char* name) {
  std::uint32_t count = 0;
  vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data());
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

bool has_layer(const char* name) {
  std::uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(),
                     [&](const auto& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

}  // namespace

const char* type_name(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU: return "CPU";
    default: return "other";
  }
}

VkBool32 VKAPI_PTR Host::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/,
                                    VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  auto* host = static_cast<Host*>(user);
  const std::lock_guard<std::mutex> lock(host->message_mutex_);
  if (++host->validation_count_ <= 8) host->validation_text_ += std::string(data->pMessage) + "\n";
  if (host->validation_log_ != nullptr) host->validation_log_->emplace_back(data->pMessage);
  return VK_FALSE;
}

Result<void> Host::create_instance(bool validation, const std::vector<const char*>& wanted_extensions) {
  VkApplicationInfo application = {};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pApplicationName = "tyndall";
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;

  const char* layers[] = {kValidationLayer};
  std::vector<const char*> extensions = wanted_extensions;
  const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  VkDebugUtilsMessengerCreateInfoEXT messenger = {};
  messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  messenger.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  messenger.pfnUserCallback = on_message;
  messenger.pUserData = this;
  VkValidationFeaturesEXT features = {};
  features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
  features.pNext = &messenger;
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = enables;
  if (validation) {
    if (!has_layer(kValidationLayer)) {
      return Error{ErrorCode::unsupported_device,
                   "the Vulkan validation layer is not installed; expected Debian's vulkan-validationlayers"};
    }
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = layers;
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  }
  // Without it, the loader hides drivers that are layered on another API, such as MoltenVK.
  if (has_instance_extension(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME)) {
    extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
    info.flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;
  }
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
  if (result != VK_SUCCESS) {
    return Error{ErrorCode::unsupported_device,
                 "Vulkan does not start (VkResult " + std::to_string(static_cast<int>(result)) +
                     "); expected a Vulkan 1.3 driver (without a GPU: Debian's mesa-vulkan-drivers)",
                 static_cast<std::int32_t>(result)};
  }
  if (validation) {
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    if (create != nullptr) create(instance_, &messenger, nullptr, &messenger_);
  }
  return {};
}

Result<void> Host::create_device(const HostDesc& desc) {
  TYNDALL_ASSIGN(const std::vector<VkPhysicalDevice> devices, enumerate(instance_));
  std::vector<DeviceRow> rows;
  for (VkPhysicalDevice device : devices) {
    rows.push_back(describe(device));
    for (const char* extension : desc.device_extensions) {
      if (!has_extension(device, extension)) rows.back().missing.emplace_back(extension);
    }
    const QueueFamily family = find_queue_family(device);
    if (desc.graphics && !family.graphics) rows.back().missing.emplace_back(kGraphics);
    if (desc.can_present && family.graphics && !desc.can_present(instance_, device, family.index)) {
      rows.back().missing.emplace_back("a queue that can present to this display");
    }
  }
  TYNDALL_ASSIGN(const std::size_t index, choose(rows, desc.device));
  device_.instance = instance_;
  device_.physical_device = devices[index];
  const QueueFamily family = find_queue_family(devices[index]);
  queue_family_ = family.index;
  timestamps_ = family.timestamps;

  const std::vector<float> priorities(std::clamp(desc.queues, 1U, family.queues), 1.0F);
  VkDeviceQueueCreateInfo queue = {};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = queue_family_;
  queue.queueCount = static_cast<std::uint32_t>(priorities.size());
  queue.pQueuePriorities = priorities.data();
  VkPhysicalDeviceVulkan13Features features = {};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  features.dynamicRendering = VK_TRUE;
  std::vector<const char*> extensions = desc.device_extensions;
  Portability portability = portability_of(device_.physical_device);
  if (portability.subset) {
    extensions.push_back(VK_KHR_PORTABILITY_SUBSET_EXTENSION_NAME);
    features.pNext = &portability.features;
  }
  VkDeviceCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = &features;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  VkResult result = vkCreateDevice(device_.physical_device, &info, nullptr, &device_.device);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating the Vulkan device", rows[index].name.c_str());
  TYNDALL_TRY(init_device(device_, get_instance_proc_addr_));
  queues_.resize(priorities.size());
  for (std::uint32_t i = 0; i < queue.queueCount; ++i) {
    vkGetDeviceQueue(device_.device, queue_family_, i, &queues_[i]);
  }

  VkCommandPoolCreateInfo pool_info = {};
  pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool_info.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool_info.queueFamilyIndex = queue_family_;
  VkCommandPool pool = VK_NULL_HANDLE;
  result = device_.vk.CreateCommandPool(device_.device, &pool_info, nullptr, &pool);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating", "the command pool");
  pool_ = Handle<VkCommandPool>(device_, pool);
  VkCommandBufferAllocateInfo allocate = {};
  allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  allocate.commandPool = pool;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  VkFenceCreateInfo fence_info = {};
  fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  for (Slot& slot : slots_) {
    slot.sets.create(device_);
    result = device_.vk.AllocateCommandBuffers(device_.device, &allocate, &slot.cmd);
    if (result != VK_SUCCESS) return vulkan_error(result, "allocating", "the command buffer");
    VkFence fence = VK_NULL_HANDLE;
    result = device_.vk.CreateFence(device_.device, &fence_info, nullptr, &fence);
    if (result != VK_SUCCESS) return vulkan_error(result, "creating", "the fence");
    slot.fence = Handle<VkFence>(device_, fence);
  }
  return {};
}

Result<std::unique_ptr<Host>> Host::create(const HostDesc& desc) {
  std::unique_ptr<Host> host(new Host());
  host->validation_log_ = desc.validation_log;
  if (desc.get_instance_proc_addr != nullptr) host->get_instance_proc_addr_ = desc.get_instance_proc_addr;
  TYNDALL_TRY(host->create_instance(desc.validation, desc.instance_extensions));
  TYNDALL_TRY(host->create_device(desc));
  return host;
}

Host::~Host() {
  if (device_.device != VK_NULL_HANDLE && device_.vk.DeviceWaitIdle != nullptr) {
    device_.vk.DeviceWaitIdle(device_.device);
  }
  for (Slot& slot : slots_) slot = {};
  pool_.reset();
  if (device_.device != VK_NULL_HANDLE) vkDestroyDevice(device_.device, nullptr);
  if (messenger_ != VK_NULL_HANDLE) {
    const auto destroy_messenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    if (destroy_messenger != nullptr) destroy_messenger(instance_, messenger_, nullptr);
  }
  if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

Result<std::vector<DeviceRow>> Host::list(const std::string& wanted) {
  std::unique_ptr<Host> host(new Host());
  TYNDALL_TRY(host->create_instance(false));
  TYNDALL_ASSIGN(const std::vector<VkPhysicalDevice> devices, enumerate(host->instance_));
  std::vector<DeviceRow> rows;
  for (VkPhysicalDevice device : devices) rows.push_back(describe(device));
  // Prefers a device that can also draw.
  std::vector<DeviceRow> drawing = rows;
  for (DeviceRow& row : drawing) {
    if (!row.graphics) row.missing.emplace_back(kGraphics);
  }
  Result<std::size_t> chosen = choose(drawing, wanted);
  if (!chosen.ok()) chosen = choose(rows, wanted);
  if (chosen.ok()) {
    rows[chosen.value()].chosen = true;
  } else if (!wanted.empty() || rows.empty()) {
    return chosen.error();
  }
  return rows;
}

Result<void> Host::run(const Record& record) {
  const std::lock_guard<std::mutex> running(run_mutex_);
  TYNDALL_ASSIGN(const std::uint64_t submission, record_and_submit(record));
  return wait_for(*pending(submission));
}

Result<std::uint64_t> Host::submit(const Record& record) {
  const std::lock_guard<std::mutex> running(run_mutex_);
  return record_and_submit(record);
}

Result<void> Host::wait(std::uint64_t submission) {
  const std::lock_guard<std::mutex> running(run_mutex_);
  Slot* const slot = pending(submission);
  return slot != nullptr ? wait_for(*slot) : Result<void>();
}

Result<void> Host::wait_for_all() {
  const std::lock_guard<std::mutex> running(run_mutex_);
  Slot* const newest = pending(submissions_);
  return newest != nullptr ? wait_for(*newest) : Result<void>();
}

void Host::wait_idle() {
  const std::unique_lock<std::mutex> locked = lock();
  device_.vk.DeviceWaitIdle(device_.device);
}

Host::Slot* Host::pending(std::uint64_t submission) {
  if (submission == 0) return nullptr;
  const auto slot =
      std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) { return s.submission == submission; });
  return slot != slots_.end() ? &*slot : nullptr;
}

Result<std::uint64_t> Host::record_and_submit(const Record& record) {
  // A free slot, whose number is 0, or the slot of the oldest submission.
  const auto least = std::min_element(slots_.begin(), slots_.end(),
                                      [](const Slot& a, const Slot& b) { return a.submission < b.submission; });
  recording_ = static_cast<std::size_t>(least - slots_.begin());
  Slot& slot = *least;
  if (slot.submission != 0) TYNDALL_TRY(wait_for(slot));
  slot.sets.reset();
  VkCommandBufferBeginInfo begin = {};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  VkResult result = device_.vk.BeginCommandBuffer(slot.cmd, &begin);
  if (result != VK_SUCCESS) return vulkan_error(result, "beginning", "a command buffer");
  Result<void> recorded;
  try {
    recorded = record(slot.cmd);
  } catch (...) {
    device_.vk.EndCommandBuffer(slot.cmd);  // otherwise the next call could not begin
    throw;
  }
  result = device_.vk.EndCommandBuffer(slot.cmd);
  if (!recorded.ok()) return recorded.error();
  if (result != VK_SUCCESS) return vulkan_error(result, "ending", "a command buffer");
  VkSubmitInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  info.commandBufferCount = 1;
  info.pCommandBuffers = &slot.cmd;
  {
    const std::unique_lock<std::mutex> locked = lock();
    result = device_.vk.QueueSubmit(queue(), 1, &info, slot.fence.get());
  }
  if (result != VK_SUCCESS) return vulkan_error(result, "submitting", "a command buffer");
  slot.submission = ++submissions_;
  return submissions_;
}

Result<void> Host::wait_for(Slot& slot) {
  const VkFence fence = slot.fence.get();
  VkResult result = device_.vk.WaitForFences(device_.device, 1, &fence, VK_TRUE, UINT64_MAX);
  if (result != VK_SUCCESS) {
    // A wait that ran out of memory leaves the commands running, and the caller would free what they use.
    const std::unique_lock<std::mutex> locked = lock();
    result = device_.vk.DeviceWaitIdle(device_.device);
  }
  slot.submission = 0;
  if (result != VK_SUCCESS) return vulkan_error(result, "waiting for", "the device");
  device_.vk.ResetFences(device_.device, 1, &fence);
  return {};
}

}  // namespace tyndall::gpu
