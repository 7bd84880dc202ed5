// The parts of `tyndall report` that look into the device: a frame under the validation layer, and the statistics of
// the compiled pipelines (VK_KHR_pipeline_executable_properties).
#include <vulkan/vulkan.h>

#include <cstring>
#include <map>
#include <string_view>

#include "cli.hpp"
#include "files/text.hpp"
#include "gpu/host.hpp"
#include "make_tables.hpp"
#include "report_parts.hpp"
#include "scene/scene.hpp"
#include "tyndall/effect.hpp"

namespace tyndall::cli {
namespace {

using Json = nlohmann::ordered_json;

// The data that the hooks below record. The library calls Vulkan through the function that it is given, so that
// pipelines can be created with statistics, and named, without a change of the library.
struct Recorded {
  PFN_vkGetDeviceProcAddr get_device_proc_addr = nullptr;
  PFN_vkCreateComputePipelines create_compute_pipelines = nullptr;
  PFN_vkGetPipelineExecutablePropertiesKHR get_executables = nullptr;
  PFN_vkGetPipelineExecutableStatisticsKHR get_statistics = nullptr;
  std::vector<VkPipeline> order;
  std::map<VkPipeline, Json> executables;
  std::map<VkPipeline, std::string> names;
};
Recorded recorded;

Json value_of(const VkPipelineExecutableStatisticKHR& statistic) {
  switch (statistic.format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR: return statistic.value.b32 != 0;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR: return statistic.value.i64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR: return statistic.value.u64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR: return statistic.value.f64;
    default: return nullptr;
  }
}

Json executables_of(VkDevice device, VkPipeline pipeline) {
  Json out = Json::array();
  VkPipelineInfoKHR info = {};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR;
  info.pipeline = pipeline;
  std::uint32_t count = 0;
  recorded.get_executables(device, &info, &count, nullptr);
  VkPipelineExecutablePropertiesKHR blank_properties = {};
  blank_properties.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
  std::vector<VkPipelineExecutablePropertiesKHR> properties(count, blank_properties);
  recorded.get_executables(device, &info, &count, properties.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    VkPipelineExecutableInfoKHR executable = {};
    executable.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR;
    executable.pipeline = pipeline;
    executable.executableIndex = i;
    std::uint32_t statistic_count = 0;
    recorded.get_statistics(device, &executable, &statistic_count, nullptr);
    VkPipelineExecutableStatisticKHR blank = {};
    blank.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
    std::vector<VkPipelineExecutableStatisticKHR> statistics(statistic_count, blank);
    recorded.get_statistics(device, &executable, &statistic_count, statistics.data());
    Json row = {
        {"name", properties[i].name}, {"subgroup_size", properties[i].subgroupSize}, {"statistics", Json::object()}};
    for (std::uint32_t k = 0; k < statistic_count; ++k) row["statistics"][statistics[k].name] = value_of(statistics[k]);
    out.push_back(std::move(row));
  }
  return out;
}

VKAPI_ATTR VkResult VKAPI_CALL create_with_statistics(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                                      const VkComputePipelineCreateInfo* infos,
                                                      const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
  std::vector<VkComputePipelineCreateInfo> changed(infos, infos + count);
  for (VkComputePipelineCreateInfo& info : changed) info.flags |= VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
  const VkResult result = recorded.create_compute_pipelines(device, cache, count, changed.data(), allocator, pipelines);
  for (std::uint32_t i = 0; result == VK_SUCCESS && i < count; ++i) {
    recorded.order.push_back(pipelines[i]);
    recorded.executables[pipelines[i]] = executables_of(device, pipelines[i]);
  }
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL record_name(VkDevice /*device*/, const VkDebugUtilsObjectNameInfoEXT* info) {
  if (info->objectType == VK_OBJECT_TYPE_PIPELINE && info->pObjectName != nullptr) {
    recorded.names[reinterpret_cast<VkPipeline>(info->objectHandle)] = info->pObjectName;
  }
  return VK_SUCCESS;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name) {
  if (std::strcmp(name, "vkCreateComputePipelines") == 0) {
    return reinterpret_cast<PFN_vkVoidFunction>(&create_with_statistics);
  }
  if (std::strcmp(name, "vkSetDebugUtilsObjectNameEXT") == 0) return reinterpret_cast<PFN_vkVoidFunction>(&record_name);
  return recorded.get_device_proc_addr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name) {
  // The library names objects only if the instance has this function.
  if (std::strcmp(name, "vkSetDebugUtilsObjectNameEXT") == 0) return reinterpret_cast<PFN_vkVoidFunction>(&record_name);
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(&device_function);
  return vkGetInstanceProcAddr(instance, name);
}

bool has_extension(VkPhysicalDevice device, std::string_view name) {
  std::uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> list(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, list.data());
  for (const VkExtensionProperties& extension : list) {
    if (name == extension.extensionName) return true;
  }
  return false;
}

// Creates a second device, with the extension. The first one belongs to `host`.
Result<VkDevice> device_with_statistics(const gpu::Host& host) {
  const gpu::Device& first = host.device();
  constexpr const char* kExtension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
  if (!has_extension(first.physical_device, kExtension)) {
    return Error{ErrorCode::unsupported_device, std::string("the device has no ") + kExtension, 0};
  }
  const Requirements needed = requirements();
  std::vector<const char*> extensions(needed.device_extensions.begin(), needed.device_extensions.end());
  extensions.push_back(kExtension);
  VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR features = {};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR;
  features.pipelineExecutableInfo = VK_TRUE;
  const float priority = 1.0F;
  VkDeviceQueueCreateInfo queue = {};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = host.queue_family();
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = &features;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  VkDevice device = VK_NULL_HANDLE;
  const VkResult result = vkCreateDevice(first.physical_device, &info, nullptr, &device);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "creating", "a device with statistics of pipelines");
  return device;
}

}  // namespace

int run_validation_part(const std::string& device) {
  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({device, true});
  if (!host) return fail(host.error());
  const config::Settings settings;
  scene::SceneDesc desc;
  desc.extent = {320, 180};
  desc.make_tables = make_tables(settings.scene);
  {
    Result<std::unique_ptr<scene::Scene>> scene =
        scene::Scene::create(*host.value(), desc, settings.effect, settings.scene);
    if (!scene) return fail(scene.error());
    constexpr int kFrames = 3;
    for (int frame = 0; frame < kFrames; ++frame) {
      if (Result<void> r = scene.value()->render(0.0); !r) return fail(r.error());
    }
  }
  constexpr std::size_t kLongest = 2000;
  const Json out = {{"messages", host.value()->validation_messages()},
                    {"text", files::one_line(host.value()->validation_text(), kLongest)}};
  return print(out.dump() + "\n");
}

int run_pipelines_part(const std::string& device_name) {
  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({device_name, false});
  if (!host) return fail(host.error());
  const Result<VkDevice> device = device_with_statistics(*host.value());
  if (!device) return fail(device.error());
  const VkInstance instance = host.value()->device().instance;
  recorded.get_device_proc_addr =
      reinterpret_cast<PFN_vkGetDeviceProcAddr>(vkGetInstanceProcAddr(instance, "vkGetDeviceProcAddr"));
  const auto load = [&](const char* name) { return recorded.get_device_proc_addr(device.value(), name); };
  recorded.create_compute_pipelines = reinterpret_cast<PFN_vkCreateComputePipelines>(load("vkCreateComputePipelines"));
  recorded.get_executables =
      reinterpret_cast<PFN_vkGetPipelineExecutablePropertiesKHR>(load("vkGetPipelineExecutablePropertiesKHR"));
  recorded.get_statistics =
      reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(load("vkGetPipelineExecutableStatisticsKHR"));
  DeviceInfo info;
  info.instance = instance;
  info.physical_device = host.value()->device().physical_device;
  info.device = device.value();
  info.get_instance_proc_addr = instance_function;
  int status = kDone;
  {
    EffectDesc desc;
    desc.pipeline_threads = 1;  // the records above are not locked
    const Result<Effect> effect = Effect::create(info, desc, Params());
    if (!effect) status = fail(effect.error());
  }
  vkDestroyDevice(device.value(), nullptr);
  if (status != kDone) return status;
  Json out = Json::array();
  for (const VkPipeline pipeline : recorded.order) {
    out.push_back({{"name", recorded.names[pipeline]}, {"executables", recorded.executables[pipeline]}});
  }
  return print(out.dump() + "\n");
}

}  // namespace tyndall::cli
