#include "faults.hpp"

#include <dlfcn.h>
#include <vulkan/vulkan_beta.h>

#include <cstdlib>
#include <cstring>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "gpu/functions.hpp"

namespace tyndall::faults {
namespace {

thread_local Kind armed_kind = Kind::vulkan;
thread_local long left = -1;  // number of calls before the one that fails; < 0: none fails
thread_local bool has_failed = false;
thread_local int in_driver = 0;

bool fails(Kind kind) {
  if (left < 0 || kind != armed_kind || in_driver > 0 || left-- > 0) return false;
  has_failed = true;
  return true;
}

// Returns whether a destructor of nlohmann::json allocates, which would terminate the program if it failed. The name of
// the function that called operator new is known because the program exports its symbols.
bool is_of_json(const void* caller) {
  Dl_info info = {};
  return dladdr(caller, &info) != 0 && info.dli_sname != nullptr &&
         std::string_view(info.dli_sname).find("nlohmann") != std::string_view::npos;
}

constexpr bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}
constexpr bool makes(std::string_view name) {
  return starts_with(name, "Create") || starts_with(name, "Allocate") || starts_with(name, "Bind") ||
         starts_with(name, "Map");
}
constexpr VkResult kError = VK_ERROR_OUT_OF_DEVICE_MEMORY;

gpu::Functions real;
std::function<void(VkPhysicalDeviceProperties2&)> change_properties;
std::optional<PortabilitySubset> portability;

template <auto kMember, bool kMakes, typename Function>
struct Wrapped;
template <auto kMember, bool kMakes, typename R, typename... Args>
struct Wrapped<kMember, kMakes, R(VKAPI_PTR*)(Args...)> {
  static R VKAPI_CALL call(Args... args) {
    if constexpr (kMakes && std::is_same_v<R, VkResult>) {
      if (fails(Kind::vulkan)) return kError;
    }
    if constexpr (std::is_same_v<PFN_vkQueueSubmit, R(VKAPI_PTR*)(Args...)>) {
      if (fails(Kind::submission)) return kError;
    }
    struct InDriver {
      InDriver() { ++in_driver; }
      ~InDriver() { --in_driver; }
    } const driver;
    return (real.*kMember)(args...);
  }
};

void VKAPI_CALL properties(VkPhysicalDevice device, VkPhysicalDeviceProperties2* out) {
  real.GetPhysicalDeviceProperties2(device, out);
  if (change_properties) change_properties(*out);
}

PFN_vkVoidFunction VKAPI_CALL device_proc_addr(VkDevice device, const char* name) {
  const std::string_view wanted = name;
#define X(function)                                                                           \
  if (wanted == "vk" #function) {                                                             \
    real.function = reinterpret_cast<PFN_vk##function>(real.GetDeviceProcAddr(device, name)); \
    if (real.function == nullptr) return nullptr;                                             \
    return reinterpret_cast<PFN_vkVoidFunction>(                                              \
        Wrapped<&gpu::Functions::function, makes(#function), PFN_vk##function>::call);        \
  }
  TYNDALL_DEVICE_FUNCTIONS(X)
  TYNDALL_DEBUG_FUNCTIONS(X)
#undef X
  return real.GetDeviceProcAddr(device, name);
}

// The state of the fake device. Objects are numbers, which are never reused.
std::map<std::uint64_t, VkDeviceSize> live;  // bytes of buffers and images
std::map<std::uint64_t, void*> memory;
std::uint64_t next_object = 1;
std::size_t pipeline_objects = 0;
std::size_t hash = 0;

// Events that the recorded commands will set, and events that are set.
bool recording = false;
std::vector<VkEvent> to_set;
std::set<VkEvent> set_events;

VkDeviceSize bytes_of(const VkMemoryAllocateInfo& info) { return info.allocationSize; }
VkDeviceSize bytes_of(const VkBufferCreateInfo& info) { return (info.size + 255) / 256 * 256; }
VkDeviceSize bytes_of(const VkImageCreateInfo& info) {
  return VkDeviceSize{16} * info.extent.width * info.extent.height * info.extent.depth * info.arrayLayers;
}
template <typename Info>
VkDeviceSize bytes_of(const Info&) {
  return 0;
}
template <typename T>
constexpr bool kOfPipelines = std::is_same_v<T, VkPipeline> || std::is_same_v<T, VkPipelineLayout> ||
                              std::is_same_v<T, VkDescriptorSetLayout> || std::is_same_v<T, VkDescriptorPool>;

template <typename T>
VkResult make(T* out, VkDeviceSize bytes) {
  if (fails(Kind::vulkan)) return kError;
  ++in_driver;  // allocations in here count as those of the driver
  live[next_object] = bytes;
  --in_driver;
  if constexpr (kOfPipelines<T>) ++pipeline_objects;
  *out = reinterpret_cast<T>(next_object++);
  return VK_SUCCESS;
}

// The functions of the device, grouped by the types of their arguments.
template <typename Info, typename T>
VkResult fake(VkDevice, const Info* info, const VkAllocationCallbacks*, T* out) {
  return make(out, bytes_of(*info));
}
VkResult fake(VkDevice, VkPipelineCache, std::uint32_t, const VkComputePipelineCreateInfo*,
              const VkAllocationCallbacks*, VkPipeline* out) {
  return make(out, 0);
}
VkResult fake(VkDevice, VkDeviceMemory of, VkDeviceSize, VkDeviceSize, VkMemoryMapFlags, void** out) {
  if (fails(Kind::vulkan)) return kError;
  ++in_driver;
  const auto number = reinterpret_cast<std::uint64_t>(of);
  void*& mapped = memory[number];
  if (mapped == nullptr) mapped = std::calloc(1, live.at(number));
  --in_driver;
  *out = mapped;
  return VK_SUCCESS;
}
template <typename T>
VkResult fake(VkDevice, T, VkDeviceMemory, VkDeviceSize) {  // binds
  return fails(Kind::vulkan) ? kError : VK_SUCCESS;
}
template <typename T, typename = std::enable_if_t<std::is_pointer_v<T>>>
void fake(VkDevice, T object, const VkAllocationCallbacks*) {
  const auto number = reinterpret_cast<std::uint64_t>(object);
  if (live.erase(number) != 1) std::abort();  // destroyed twice, or never created
  if constexpr (kOfPipelines<T>) --pipeline_objects;
  if (const auto found = memory.find(number); found != memory.end()) {
    std::free(found->second);
    memory.erase(found);
  }
}
void require(VkMemoryRequirements& out, VkDeviceSize bytes) { out = {bytes, 256, 1}; }
template <typename T>
void fake(VkDevice, T object, VkMemoryRequirements* out) {
  require(*out, live.at(reinterpret_cast<std::uint64_t>(object)));
}
template <typename Query>
void fake(VkDevice, const Query* query, VkMemoryRequirements2* out) {
  require(out->memoryRequirements, bytes_of(*query->pCreateInfo));
}
// Commands, and other functions that the tests do not depend on. Pointers are not hashed, because their targets may be
// temporary.
template <typename T>
void mix(const T& value) {
  if constexpr (std::is_integral_v<T>) hash = (hash ^ static_cast<std::size_t>(value)) * 0x100000001b3U;
}
void mix_bytes(const void* from, std::size_t size) {
  const char* bytes = static_cast<const char*>(from);
  for (std::size_t i = 0; i + sizeof(std::uint64_t) <= size; i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + i, sizeof word);
    mix(word);
  }
  for (std::size_t i = size / sizeof(std::uint64_t) * sizeof(std::uint64_t); i < size; ++i) mix(bytes[i]);
}
// Objects are hashed by their sizes and the order of their first appearance, not by their numbers, because they may
// have been replaced by equal ones.
std::map<std::uint64_t, std::size_t> appeared;
template <typename T>
void mix_object(T object) {
  const auto number = reinterpret_cast<std::uint64_t>(object);
  ++in_driver;
  mix(appeared.try_emplace(number, appeared.size()).first->second);
  --in_driver;
  if (const auto found = live.find(number); found != live.end()) mix(found->second);
}
void mix(VkImageView view) { mix_object(view); }
void mix(VkBuffer buffer) { mix_object(buffer); }
void mix(VkImage image) { mix_object(image); }
void mix(VkPipeline pipeline) { mix_object(pipeline); }

template <auto kMember, typename Function>
struct Fake;
template <auto kMember, typename R, typename... Args>
struct Fake<kMember, R(VKAPI_PTR*)(Args...)> {
  static R VKAPI_CALL call(Args... args) {
    if constexpr (requires { fake(args...); }) {
      return fake(args...);
    } else {
      mix(reinterpret_cast<std::uint64_t>(&call));
      (mix(args), ...);
      if constexpr (!std::is_void_v<R>) return R{};
    }
  }
};
// Descriptor sets. They belong to their pool, so they are not counted.
using Written = std::tuple<VkBuffer, VkDeviceSize, VkImageView>;
std::map<std::uint64_t, std::map<std::uint32_t, Written>> sets;  // by set and binding
VkResult VKAPI_CALL allocate_sets(VkDevice, const VkDescriptorSetAllocateInfo* info, VkDescriptorSet* out) {
  if (fails(Kind::vulkan)) return kError;
  for (std::uint32_t i = 0; i < info->descriptorSetCount; ++i) {
    out[i] = reinterpret_cast<VkDescriptorSet>(next_object++);
  }
  return VK_SUCCESS;
}
void VKAPI_CALL update_sets(VkDevice, std::uint32_t count, const VkWriteDescriptorSet* writes, std::uint32_t,
                            const VkCopyDescriptorSet*) {
  ++in_driver;
  for (std::uint32_t i = 0; i < count; ++i) {
    sets[reinterpret_cast<std::uint64_t>(writes[i].dstSet)][writes[i].dstBinding] = {
        writes[i].pBufferInfo->buffer, writes[i].pBufferInfo->offset, writes[i].pImageInfo->imageView};
  }
  --in_driver;
}
// Hashes the descriptors of a pass.
void VKAPI_CALL bind_sets(VkCommandBuffer, VkPipelineBindPoint, VkPipelineLayout, std::uint32_t, std::uint32_t count,
                          const VkDescriptorSet* bound, std::uint32_t, const std::uint32_t*) {
  for (std::uint32_t i = 0; i < count; ++i) {
    for (const auto& [binding, written] : sets.at(reinterpret_cast<std::uint64_t>(bound[i]))) {
      std::apply([](const auto&... part) { (mix(part), ...); }, written);
    }
  }
}

void VKAPI_CALL push_constants(VkCommandBuffer, VkPipelineLayout, VkShaderStageFlags, std::uint32_t, std::uint32_t size,
                               const void* values) {
  mix_bytes(values, size);
}
void VKAPI_CALL begin_rendering(VkCommandBuffer, const VkRenderingInfo* info) {
  for (std::uint32_t i = 0; i < info->colorAttachmentCount; ++i) mix(info->pColorAttachments[i].imageView);
  if (info->pDepthAttachment != nullptr) mix(info->pDepthAttachment->imageView);
}

// Command buffers and events. Commands take effect immediately on submission, or when they are recorded if no command
// buffer has been begun.
VkResult VKAPI_CALL allocate_command_buffers(VkDevice, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* out) {
  if (fails(Kind::vulkan)) return kError;
  for (std::uint32_t i = 0; i < info->commandBufferCount; ++i) out[i] = reinterpret_cast<VkCommandBuffer>(next_object);
  return VK_SUCCESS;
}
VkResult VKAPI_CALL begin_command_buffer(VkCommandBuffer, const VkCommandBufferBeginInfo*) {
  if (recording) std::abort();  // begun twice
  if (fails(Kind::vulkan)) return kError;
  recording = true;
  to_set.clear();
  return VK_SUCCESS;
}
VkResult VKAPI_CALL end_command_buffer(VkCommandBuffer) {
  recording = false;
  return fails(Kind::submission) ? kError : VK_SUCCESS;
}
void VKAPI_CALL set_event(VkCommandBuffer, VkEvent event, VkPipelineStageFlags) {
  ++in_driver;
  if (recording) {
    to_set.push_back(event);
  } else {
    set_events.insert(event);
  }
  --in_driver;
}
VkResult VKAPI_CALL reset_event(VkDevice, VkEvent event) {
  set_events.erase(event);
  return VK_SUCCESS;
}
VkResult VKAPI_CALL event_status(VkDevice, VkEvent event) {
  return set_events.contains(event) ? VK_EVENT_SET : VK_EVENT_RESET;
}
VkResult VKAPI_CALL submit(VkQueue, std::uint32_t, const VkSubmitInfo*, VkFence) {
  if (fails(Kind::submission)) return kError;
  ++in_driver;
  set_events.insert(to_set.begin(), to_set.end());
  to_set.clear();
  --in_driver;
  // Add the memory that the commands may read, independent of its order.
  const std::size_t before = std::exchange(hash, 0);
  std::size_t sum = 0;
  for (const auto& [number, bytes] : memory) {
    mix_bytes(bytes, live.at(number));
    sum += std::exchange(hash, 0);
  }
  hash = before;
  mix(sum);
  return VK_SUCCESS;
}

void VKAPI_CALL fake_properties(VkPhysicalDevice, VkPhysicalDeviceProperties2* out) {
  VkPhysicalDeviceLimits& limits = out->properties.limits;
  std::memset(&limits, 0x7F, sizeof limits);  // large integers
  limits.timestampPeriod = 1.0F;
  for (auto* next = static_cast<VkBaseOutStructure*>(out->pNext); next != nullptr; next = next->pNext) {
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES) {
      reinterpret_cast<VkPhysicalDeviceMaintenance3Properties*>(next)->maxMemoryAllocationSize = UINT64_MAX;
    }
    if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES) {
      reinterpret_cast<VkPhysicalDeviceMaintenance4Properties*>(next)->maxBufferSize = UINT64_MAX;
    }
  }
  if (change_properties) change_properties(*out);
}
void VKAPI_CALL fake_memory(VkPhysicalDevice, VkPhysicalDeviceMemoryProperties* out) {
  *out = {};
  out->memoryTypeCount = 1;
  out->memoryTypes[0].propertyFlags =
      VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  out->memoryHeapCount = 1;
  out->memoryHeaps[0].size = VkDeviceSize{1} << 40;
}
VkResult VKAPI_CALL fake_queries(VkDevice, VkQueryPool, std::uint32_t, std::uint32_t, std::size_t, void*, VkDeviceSize,
                                 VkQueryResultFlags) {
  return VK_NOT_READY;
}

PFN_vkVoidFunction VKAPI_CALL fake_device_proc(VkDevice, const char* name) {
  const std::string_view wanted = name;
  const std::pair<std::string_view, PFN_vkVoidFunction> own[] = {
      {"vkAllocateDescriptorSets", reinterpret_cast<PFN_vkVoidFunction>(allocate_sets)},
      {"vkUpdateDescriptorSets", reinterpret_cast<PFN_vkVoidFunction>(update_sets)},
      {"vkCmdBindDescriptorSets", reinterpret_cast<PFN_vkVoidFunction>(bind_sets)},
      {"vkCmdPushConstants", reinterpret_cast<PFN_vkVoidFunction>(push_constants)},
      {"vkCmdBeginRendering", reinterpret_cast<PFN_vkVoidFunction>(begin_rendering)},
      {"vkCmdSetEvent", reinterpret_cast<PFN_vkVoidFunction>(set_event)},
      {"vkResetEvent", reinterpret_cast<PFN_vkVoidFunction>(reset_event)},
      {"vkGetEventStatus", reinterpret_cast<PFN_vkVoidFunction>(event_status)},
      {"vkGetQueryPoolResults", reinterpret_cast<PFN_vkVoidFunction>(fake_queries)},
      {"vkAllocateCommandBuffers", reinterpret_cast<PFN_vkVoidFunction>(allocate_command_buffers)},
      {"vkBeginCommandBuffer", reinterpret_cast<PFN_vkVoidFunction>(begin_command_buffer)},
      {"vkEndCommandBuffer", reinterpret_cast<PFN_vkVoidFunction>(end_command_buffer)},
      {"vkQueueSubmit", reinterpret_cast<PFN_vkVoidFunction>(submit)},
  };
  for (const auto& [function, address] : own) {
    if (wanted == function) return address;
  }
#define X(function)                                                                                       \
  if (wanted == "vk" #function) {                                                                         \
    return reinterpret_cast<PFN_vkVoidFunction>(Fake<&gpu::Functions::function, PFN_vk##function>::call); \
  }
  TYNDALL_DEVICE_FUNCTIONS(X)
#undef X
  return nullptr;
}

VkResult VKAPI_CALL fake_extensions(VkPhysicalDevice, const char*, std::uint32_t* count, VkExtensionProperties* out) {
  if (out != nullptr && portability) std::strcpy(out->extensionName, VK_KHR_PORTABILITY_SUBSET_EXTENSION_NAME);
  *count = portability ? 1 : 0;
  return VK_SUCCESS;
}
void VKAPI_CALL fake_features(VkPhysicalDevice, VkPhysicalDeviceFeatures2* out) {
  auto* subset = static_cast<VkPhysicalDevicePortabilitySubsetFeaturesKHR*>(out->pNext);
  subset->mutableComparisonSamplers = portability->comparison_samplers ? VK_TRUE : VK_FALSE;
  subset->events = portability->events ? VK_TRUE : VK_FALSE;
}

PFN_vkVoidFunction VKAPI_CALL fake_instance_proc(VkInstance, const char* name) {
  const std::string_view wanted = name;
  if (wanted == "vkGetDeviceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(fake_device_proc);
  if (wanted == "vkGetPhysicalDeviceProperties2") return reinterpret_cast<PFN_vkVoidFunction>(fake_properties);
  if (wanted == "vkEnumerateDeviceExtensionProperties") return reinterpret_cast<PFN_vkVoidFunction>(fake_extensions);
  if (wanted == "vkGetPhysicalDeviceFeatures2") return reinterpret_cast<PFN_vkVoidFunction>(fake_features);
  if (wanted == "vkGetPhysicalDeviceMemoryProperties") return reinterpret_cast<PFN_vkVoidFunction>(fake_memory);
  return reinterpret_cast<PFN_vkVoidFunction>(fake_memory);  // not null, and never called
}

}  // namespace

void arm(Kind kind, long n) {
  armed_kind = kind;
  has_failed = false;
  left = n;
}

bool disarm() {
  left = -1;
  return has_failed;
}

bool host_allocation_fails(const void* caller) {
  if (left == 0 && armed_kind == Kind::host && in_driver == 0 && is_of_json(caller)) return false;
  return fails(Kind::host);
}

void set_properties(std::function<void(VkPhysicalDeviceProperties2&)> change) { change_properties = std::move(change); }

void set_portability(std::optional<PortabilitySubset> subset) { portability = subset; }

PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance, const char* name) {
  const std::string_view wanted = name;
  if (wanted == "vkGetDeviceProcAddr") {
    real.GetDeviceProcAddr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(vkGetInstanceProcAddr(instance, name));
    return reinterpret_cast<PFN_vkVoidFunction>(device_proc_addr);
  }
  if (wanted == "vkGetPhysicalDeviceProperties2") {
    real.GetPhysicalDeviceProperties2 =
        reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(vkGetInstanceProcAddr(instance, name));
    return reinterpret_cast<PFN_vkVoidFunction>(properties);
  }
  return vkGetInstanceProcAddr(instance, name);
}

PFN_vkVoidFunction VKAPI_CALL get_fake_proc_addr(VkInstance instance, const char* name) {
  return fake_instance_proc(instance, name);
}

DeviceInfo fake_device() {
  DeviceInfo out;
  out.instance = reinterpret_cast<VkInstance>(std::uintptr_t{1});
  out.physical_device = reinterpret_cast<VkPhysicalDevice>(std::uintptr_t{1});
  out.device = reinterpret_cast<VkDevice>(std::uintptr_t{1});
  out.get_instance_proc_addr = fake_instance_proc;
  return out;
}

std::size_t live_objects() { return live.size() - pipeline_objects; }
std::size_t live_pipeline_objects() { return pipeline_objects; }
bool is_live(std::uint64_t object) { return live.contains(object); }
std::size_t command_hash() { return hash; }
void forget_commands() {
  hash = 0;
  appeared.clear();
}

}  // namespace tyndall::faults
