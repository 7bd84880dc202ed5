#include "shared_pipelines.hpp"

#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

namespace tyndall::shared_pipelines {
namespace {

using Words = std::vector<std::uint32_t>;

// A pipeline and the number of its users.
struct Shared {
  VkPipeline pipeline = VK_NULL_HANDLE;
  std::size_t users = 0;
};

// The state below belongs to one device; mutex guards the three maps.
std::mutex mutex;
VkDevice of_device = VK_NULL_HANDLE;
PFN_vkGetDeviceProcAddr next_get_device_proc_addr = nullptr;
PFN_vkCreateShaderModule create_module = nullptr;
PFN_vkDestroyShaderModule destroy_module = nullptr;
PFN_vkCreateComputePipelines create_pipelines = nullptr;
PFN_vkDestroyPipeline destroy_pipeline = nullptr;
std::map<VkShaderModule, Words> modules;
std::map<Words, Shared> pipelines;  // by the code of the shader and its constants
std::map<VkPipeline, Shared*> by_handle;

VkResult VKAPI_CALL module(VkDevice device, const VkShaderModuleCreateInfo* info,
                           const VkAllocationCallbacks* allocator, VkShaderModule* out) {
  const VkResult result = create_module(device, info, allocator, out);
  if (result != VK_SUCCESS) return result;
  const std::lock_guard<std::mutex> lock(mutex);
  modules[*out].assign(info->pCode, info->pCode + info->codeSize / sizeof(std::uint32_t));
  return result;
}

void VKAPI_CALL end_module(VkDevice device, VkShaderModule handle, const VkAllocationCallbacks* allocator) {
  {
    const std::lock_guard<std::mutex> lock(mutex);
    modules.erase(handle);
  }
  destroy_module(device, handle, allocator);
}

// The layout is not part of the key, because it follows from the shader. Nor is the pipeline cache.
Words key_of(const VkComputePipelineCreateInfo& info) {
  Words key = modules.at(info.stage.module);
  const VkSpecializationInfo* constants = info.stage.pSpecializationInfo;
  if (constants == nullptr) return key;
  for (std::uint32_t i = 0; i < constants->mapEntryCount; ++i) {
    const VkSpecializationMapEntry& entry = constants->pMapEntries[i];
    std::uint32_t value = 0;
    std::memcpy(&value, static_cast<const char*>(constants->pData) + entry.offset, sizeof value);
    key.push_back(entry.constantID);
    key.push_back(value);
  }
  return key;
}

// The library creates one pipeline in each call.
VkResult VKAPI_CALL pipeline(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                             const VkComputePipelineCreateInfo* info, const VkAllocationCallbacks* allocator,
                             VkPipeline* out) {
  Words key;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    key = key_of(*info);
    if (const auto found = pipelines.find(key); found != pipelines.end()) {
      ++found->second.users;
      *out = found->second.pipeline;
      return VK_SUCCESS;
    }
  }
  const VkResult result = create_pipelines(device, cache, count, info, allocator, out);
  if (result != VK_SUCCESS) return result;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto [at, is_new] = pipelines.try_emplace(std::move(key), Shared{*out, 0});
  if (!is_new) {  // another thread has created the same one
    destroy_pipeline(device, *out, allocator);
    *out = at->second.pipeline;
  }
  ++at->second.users;
  by_handle[*out] = &at->second;
  return VK_SUCCESS;
}

void VKAPI_CALL end_pipeline(VkDevice device, VkPipeline handle, const VkAllocationCallbacks* allocator) {
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (const auto found = by_handle.find(handle); found != by_handle.end()) {
      --found->second->users;
      return;
    }
  }
  destroy_pipeline(device, handle, allocator);
}

template <typename Function>
PFN_vkVoidFunction wrap(Function& next, PFN_vkVoidFunction found, Function own) {
  if (found == nullptr) return nullptr;
  next = reinterpret_cast<Function>(found);
  return reinterpret_cast<PFN_vkVoidFunction>(own);
}

PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char* name) {
  const PFN_vkVoidFunction found = next_get_device_proc_addr(device, name);
  of_device = device;
  const std::string_view wanted = name;
  if (wanted == "vkCreateShaderModule") return wrap(create_module, found, &module);
  if (wanted == "vkDestroyShaderModule") return wrap(destroy_module, found, &end_module);
  if (wanted == "vkCreateComputePipelines") return wrap(create_pipelines, found, &pipeline);
  if (wanted == "vkDestroyPipeline") return wrap(destroy_pipeline, found, &end_pipeline);
  return found;
}

}  // namespace

PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance, const char* name) {
  const PFN_vkVoidFunction found = vkGetInstanceProcAddr(instance, name);
  if (std::string_view(name) != "vkGetDeviceProcAddr") return found;
  next_get_device_proc_addr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(found);
  return reinterpret_cast<PFN_vkVoidFunction>(&get_device_proc_addr);
}

std::size_t release() {
  const std::lock_guard<std::mutex> lock(mutex);
  std::size_t used = 0;
  for (const auto& [key, shared] : pipelines) {
    used += shared.users;
    destroy_pipeline(of_device, shared.pipeline, nullptr);
  }
  pipelines.clear();
  by_handle.clear();
  modules.clear();
  return used;
}

}  // namespace tyndall::shared_pipelines
