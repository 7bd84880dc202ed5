#include "effect/step.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "effect_shaders.hpp"
#include "gpu/device.hpp"

namespace tyndall {
namespace {

constexpr std::size_t kShaders = std::size(shaders::effect_shaders);
constexpr std::size_t kMaxShaderBindings = 20;
struct ShaderResources {
  std::array<Resource, kMaxShaderBindings> list = {};
  std::size_t count = 0;
};

constexpr auto kResourceNames = [] {
  std::array<std::string_view, kResources> out = {};
  for (std::size_t i = 0; i < kResources; ++i) out[i] = kResourceInfo[i].name;
  return out;
}();

// Returns Resource::none for a binding without a resource. Lengths are compared first: compilers limit the number of
// steps at compile time.
constexpr Resource resource_of(std::string_view binding) {
  constexpr std::string_view kSuffix = "_block";
  if (binding.ends_with(kSuffix)) binding.remove_suffix(kSuffix.size());
  for (std::size_t i = 0; i < kResources; ++i) {
    const std::string_view name = kResourceNames[i];
    if (binding.size() == name.size() && binding == name) return static_cast<Resource>(i);
  }
  return Resource::none;
}

// The resources of every shader, looked up by name at compile time.
constexpr auto kShaderResources = [] {
  std::array<ShaderResources, kShaders> out = {};
  for (std::size_t i = 0; i < kShaders; ++i) {
    for (const gpu::Binding& binding : shaders::effect_shaders[i]->bindings) {
      out[i].list[out[i].count++] = resource_of(binding.name);
    }
  }
  return out;
}();

// This fails if a shader has a binding whose name is not in resources.def.
static_assert([] {
  for (const ShaderResources& shader : kShaderResources) {
    for (std::size_t i = 0; i < shader.count; ++i) {
      if (shader.list[i] == Resource::none) return false;
    }
  }
  return true;
}());

constexpr auto kShaderNames = [] {
  std::array<std::string_view, kShaders> out = {};
  for (std::size_t i = 0; i < kShaders; ++i) out[i] = shaders::effect_shaders[i]->name;
  return out;
}();

// Returns the index of the variant of every shader whose name ends in `suffix`; of shaders without it, their own.
constexpr std::array<std::size_t, kShaders> find_variants(std::string_view suffix) {
  std::array<std::size_t, kShaders> out = {};
  for (std::size_t i = 0; i < kShaders; ++i) out[i] = i;
  for (std::size_t k = 0; k < kShaders; ++k) {
    if (!kShaderNames[k].ends_with(suffix)) continue;
    const std::string_view base = kShaderNames[k].substr(0, kShaderNames[k].size() - suffix.size());
    for (std::size_t i = 0; i < kShaders; ++i) {
      if (kShaderNames[i].size() == base.size() && kShaderNames[i] == base) out[i] = k;
    }
  }
  return out;
}
constexpr auto kGpuVariants = find_variants("_gpu");
constexpr auto kSpectralVariants = find_variants("_spectral");

std::size_t index_of(const gpu::Shader& shader) {
  const auto* const* found = std::find(std::begin(shaders::effect_shaders), std::end(shaders::effect_shaders), &shader);
  return static_cast<std::size_t>(found - shaders::effect_shaders);
}

VkPipelineStageFlags stages_of(VkAccessFlags access) {
  constexpr VkAccessFlags kShader = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
  constexpr VkAccessFlags kTransfer = VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  VkPipelineStageFlags stages = 0;
  if ((access & kShader) != 0) stages |= VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT;
  if ((access & VK_ACCESS_INDIRECT_COMMAND_READ_BIT) != 0) stages |= VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT;
  if ((access & kTransfer) != 0) stages |= VK_PIPELINE_STAGE_TRANSFER_BIT;
  if ((access & VK_ACCESS_HOST_READ_BIT) != 0) stages |= VK_PIPELINE_STAGE_HOST_BIT;
  return stages;
}

}  // namespace

Target target_of(const gpu::Device& device) {
  VkPhysicalDeviceSubgroupProperties subgroups = {};
  subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
  VkPhysicalDeviceProperties2 properties = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroups, {}};
  device.vk.GetPhysicalDeviceProperties2(device.physical_device, &properties);
  const bool cpu = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  // Lists are filled with operations of subgroups (shaders/epipolar/work_list.glsl).
  const bool ballot = (subgroups.supportedOperations & VK_SUBGROUP_FEATURE_BALLOT_BIT) != 0 &&
                      (subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
  return cpu || !ballot ? Target::cpu : Target::gpu;
}

const gpu::Shader& variant_for(const gpu::Shader& shader, Target target, ColorMode color) {
  std::size_t index = index_of(shader);
  if (color == ColorMode::spectral) index = kSpectralVariants[index];
  if (target == Target::gpu) index = kGpuVariants[index];
  return *shaders::effect_shaders[index];
}

PipelineKey pipeline_key(const gpu::Shader& shader, const Specialisation& constants) {
  PipelineKey key = {&shader, {}};
  for (const std::uint32_t id : shader.constants) key.constants[id] = constants[id];
  return key;
}

std::span<const Resource> bound_resources(const gpu::Shader& shader) {
  const ShaderResources& resources = kShaderResources[index_of(shader)];
  return {resources.list.data(), resources.count};
}

SetKey set_key(const Step& step) {
  const gpu::Shader& shader = *step.pipeline.shader;
  const std::span<const Resource> resources = bound_resources(shader);
  const bool chooses = std::any_of(resources.begin(), resources.end(),
                                   [](Resource r) { return info_of(r).lifetime == Lifetime::chosen; });
  return {&shader, chooses ? step.chosen : Resource::none};
}

Uses uses_of(const Step& step) {
  Uses uses;
  switch (step.kind) {
    case Step::Kind::reset_list:
    case Step::Kind::clear: uses.add(step.chosen, VK_ACCESS_TRANSFER_WRITE_BIT); return uses;
    case Step::Kind::copy:
      uses.add(step.chosen, VK_ACCESS_TRANSFER_READ_BIT);
      uses.add(step.target, VK_ACCESS_TRANSFER_WRITE_BIT);
      return uses;
    case Step::Kind::host_read: uses.add(step.chosen, VK_ACCESS_HOST_READ_BIT); return uses;
    case Step::Kind::dispatch_indirect: uses.add(step.chosen, VK_ACCESS_INDIRECT_COMMAND_READ_BIT); break;
    case Step::Kind::dispatch: break;
  }
  const gpu::Shader& shader = *step.pipeline.shader;
  const std::span<const Resource> resources = bound_resources(shader);
  for (std::size_t i = 0; i < resources.size(); ++i) {
    const gpu::Binding& binding = shader.bindings[i];
    const bool placeholder = info_of(resources[i]).lifetime == Lifetime::chosen;
    const VkAccessFlags reads = binding.reads ? VK_ACCESS_SHADER_READ_BIT : 0;
    const VkAccessFlags writes = binding.writes ? VK_ACCESS_SHADER_WRITE_BIT : 0;
    uses.add(placeholder ? step.chosen : resources[i], reads | writes);
  }
  return uses;
}

void HazardTracker::assume(Resource resource, VkAccessFlags access) {
  State& state = states_[index_of(resource)];
  state.written |= access & kWriteAccess;
  state.read |= access & ~kWriteAccess;
}

HazardTracker::Barrier HazardTracker::before(const Uses& uses) {
  Barrier barrier;
  for (const Use& use : uses) {
    const State& state = states_[index_of(use.resource)];
    if (state.written != 0 && (use.access & ~state.visible) != 0) {
      barrier.from_access |= state.written;
      barrier.from |= stages_of(state.written);
      barrier.to_access |= use.access;
    }
    const VkAccessFlags writes = use.access & kWriteAccess;
    if (state.read != 0 && (writes & ~state.ordered) != 0) {
      barrier.from |= stages_of(state.read);
      barrier.to_access |= use.access;
    }
  }
  if (barrier.from != 0) {
    // The barrier covers all shader accesses, so that it also serves later passes.
    constexpr VkAccessFlags kShader = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
    if ((barrier.to_access & kShader) != 0) barrier.to_access |= kShader;
    barrier.to = stages_of(barrier.to_access);
    for (State& state : states_) {
      const bool covers_writes = (state.written & ~barrier.from_access) == 0;
      if (covers_writes) state.visible |= barrier.to_access;
      const bool covers_reads = (stages_of(state.read) & ~barrier.from) == 0;
      if (covers_reads) state.ordered |= barrier.to_access & kWriteAccess;
    }
  }
  for (const Use& use : uses) {
    const VkAccessFlags writes = use.access & kWriteAccess;
    if (writes != 0) states_[index_of(use.resource)] = {writes, 0, 0, 0};
  }
  for (const Use& use : uses) {
    const VkAccessFlags reads = use.access & ~kWriteAccess;
    if (reads == 0) continue;
    State& state = states_[index_of(use.resource)];
    state.read |= reads;
    state.ordered = 0;
  }
  return barrier;
}

}  // namespace tyndall
