#include "effect/limits.hpp"

#include <algorithm>
#include <string>

#include "air/phase.hpp"
#include "effect/froxel_volume.hpp"
#include "effect/resources.hpp"
#include "effect/shared.hpp"
#include "effect/table_plan.hpp"
#include "effect_shaders.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/portability.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

// Returns an error if a buffer is too large for the device. `cause`: the settings that determine its size.
Result<void> check_buffer(const gpu::Device& device, const char* name, VkDeviceSize size, const char* cause) {
  const VkDeviceSize allowed = std::min({VkDeviceSize{device.properties.limits.maxStorageBufferRange},
                                         device.max_buffer_bytes, device.max_allocation_bytes});
  if (size <= allowed) return {};
  return Error{ErrorCode::invalid_argument,
               std::string(cause) + " need a buffer (" + name + ") of " + std::to_string(size) +
                   " bytes; expected at most the limit of this device, " + std::to_string(allowed)};
}

}  // namespace

Result<void> check_desc(const DeviceInfo& info, const EffectDesc& desc) {
  const auto invalid = [](const char* text) { return Error{ErrorCode::invalid_argument, text}; };
  if (info.device == VK_NULL_HANDLE || info.physical_device == VK_NULL_HANDLE || info.instance == VK_NULL_HANDLE ||
      info.get_instance_proc_addr == nullptr) {
    return invalid("DeviceInfo is incomplete; expected instance, physical_device, device and get_instance_proc_addr");
  }
  if ((info.memory.allocate == nullptr) != (info.memory.free == nullptr)) {
    return invalid("DeviceInfo::memory has only one of allocate and free; expected both or neither");
  }
  if (desc.max_extent.width == 0 || desc.max_extent.height == 0 || desc.max_extent.width > 16384 ||
      desc.max_extent.height > 16384) {
    return invalid("EffectDesc::max_extent is out of range; expected 1x1 to 16384x16384");
  }
  if (desc.frames_in_flight == 0 || desc.frames_in_flight > 8) {
    return invalid("EffectDesc::frames_in_flight is out of range; expected 1 to 8");
  }
  if (desc.views == 0 || desc.views > kMaxViews) return invalid("EffectDesc::views is out of range; expected 1 to 8");
  if (desc.max_cascades == 0 || desc.max_cascades > kMaxCascades) {
    return invalid("EffectDesc::max_cascades is out of range; expected 1 to 8");
  }
  if (desc.max_shadow_resolution == 0 || desc.max_shadow_resolution > 16384) {
    return invalid("EffectDesc::max_shadow_resolution is out of range; expected 1 to 16384");
  }
  if (desc.output_format != OutputFormat::rgba16f && desc.output_format != OutputFormat::rgba32f) {
    return invalid("EffectDesc::output_format has no such value; expected rgba16f or rgba32f");
  }
  if (desc.pipeline_threads == 0 || desc.pipeline_threads > 64) {
    return invalid("EffectDesc::pipeline_threads is out of range; expected 1 to 64");
  }
  if (desc.sky_depth != 0.0F && desc.sky_depth != 1.0F)
    return invalid("EffectDesc::sky_depth is out of range; expected 0 or 1");
  return {};
}

Result<void> check_same_desc(const EffectDesc& created, const EffectDesc& wanted) {
  const auto fixed = [](const char* field) {
    return Error{ErrorCode::invalid_argument,
                 std::string("EffectDesc::") + field + " has changed; expected the value of Effect::desc()"};
  };
  if (wanted.frames_in_flight != created.frames_in_flight) return fixed("frames_in_flight");
  if (wanted.views != created.views) return fixed("views");
  if (wanted.output_format != created.output_format) return fixed("output_format");
  if (wanted.sky_depth != created.sky_depth) return fixed("sky_depth");
  if (wanted.shadow_depth_reversed != created.shadow_depth_reversed) return fixed("shadow_depth_reversed");
  if (wanted.depth_format != created.depth_format) return fixed("depth_format");
  if (wanted.check_inputs != created.check_inputs) return fixed("check_inputs");
  if (wanted.timings != created.timings) return fixed("timings");
  if (wanted.counters != created.counters) return fixed("counters");
  if (wanted.pipeline_threads != created.pipeline_threads) return fixed("pipeline_threads");
  if (wanted.table_pipelines_later != created.table_pipelines_later) return fixed("table_pipelines_later");
  return {};
}

Result<void> check_device(const gpu::Device& device) {
  const gpu::Portability portability = gpu::portability_of(
      device.physical_device, device.vk.EnumerateDeviceExtensionProperties, device.vk.GetPhysicalDeviceFeatures2);
  if (const auto missing = portability.missing(); !missing.empty()) {
    return Error{ErrorCode::unsupported_device, std::string("the device has VK_KHR_portability_subset without ") +
                                                    missing.front() +
                                                    "; expected mutableComparisonSamplers and events"};
  }
  const std::uint32_t side = device.properties.limits.maxImageDimension3D;
  if (side < kSourceFunction.extent.height) {
    return Error{ErrorCode::unsupported_device, "the device allows 3D images of " + std::to_string(side) +
                                                    " texels along an axis; expected at least " +
                                                    std::to_string(kSourceFunction.extent.height)};
  }
  for (const gpu::Shader* shader : shaders::effect_shaders) TYNDALL_TRY(gpu::check_shader(device, *shader));
  // No dispatch has more than kMaxGroups workgroups along an axis.
  const std::uint32_t* groups = device.properties.limits.maxComputeWorkGroupCount;
  const std::uint32_t smallest = std::min({groups[0], groups[1], groups[2]});
  if (smallest >= shared::kMaxGroups) return {};
  return Error{ErrorCode::unsupported_device, "the device allows dispatches of " + std::to_string(smallest) +
                                                  " workgroups; expected at least " +
                                                  std::to_string(shared::kMaxGroups)};
}

Result<void> check_limits(const gpu::Device& device, const EffectDesc& desc, const Params& params) {
  TYNDALL_TRY(check_table_size(device, params));
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    const gpu::ImageDesc table = table_desc(static_cast<TableId>(i), params);
    const VkDeviceSize bytes = gpu::image_bytes(device, table);
    if (bytes <= device.max_allocation_bytes) continue;
    return Error{ErrorCode::invalid_argument, std::string("tables.size needs an image (") + table.name + ") of " +
                                                  std::to_string(bytes) +
                                                  " bytes; expected at most the limit of this device, " +
                                                  std::to_string(device.max_allocation_bytes)};
  }
  const bool tabulated = air::tabulated(params.atmosphere);
  for (const BufferPlan& plan : plan_scratch(params.tables.size.y, params.scattering.color, tabulated)) {
    TYNDALL_TRY(check_buffer(device, plan.name, plan.bytes, "tables.size"));
  }
  TYNDALL_TRY(check_froxels(device, params));
  const FrameBufferSizes sizes = frame_buffer_sizes(desc, params);
  for (std::size_t i = 0; i < kFrameBuffers; ++i) {
    const ResourceInfo& info = info_of(frame_buffer(i));
    TYNDALL_TRY(check_buffer(device, info.name, sizes.bytes[i], info.cause));
  }
  return {};
}

}  // namespace tyndall
