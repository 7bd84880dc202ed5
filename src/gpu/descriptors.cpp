#include "gpu/descriptors.hpp"

#include <algorithm>
#include <string>

#include "gpu/try.hpp"

namespace tyndall::gpu {
namespace {

// The types of bindings in our shaders.
constexpr std::array kTypes = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                               VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
using Counts = std::array<std::uint32_t, kTypes.size()>;

Result<Handle<VkDescriptorPool>> create_pool(const Device& device, std::uint32_t sets, const Counts& counts) {
  std::array<VkDescriptorPoolSize, kTypes.size()> sizes = {};
  std::uint32_t used = 0;
  for (std::size_t i = 0; i < kTypes.size(); ++i) {
    if (counts[i] > 0) sizes[used++] = {kTypes[i], counts[i]};
  }
  VkDescriptorPoolCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = sets;
  info.poolSizeCount = used;
  info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  const VkResult result = device.vk.CreateDescriptorPool(device.device, &info, device.allocator, &pool);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating", "the descriptor pool");
  return Handle<VkDescriptorPool>(device, pool);
}

Result<void> allocate_sets(const Device& device, VkDescriptorPool pool, std::span<const VkDescriptorSetLayout> layouts,
                           VkDescriptorSet* out) {
  VkDescriptorSetAllocateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  info.descriptorPool = pool;
  info.descriptorSetCount = static_cast<std::uint32_t>(layouts.size());
  info.pSetLayouts = layouts.data();
  const VkResult result = device.vk.AllocateDescriptorSets(device.device, &info, out);
  if (result != VK_SUCCESS) return vulkan_error(result, "allocating", "the descriptor sets");
  return {};
}

}  // namespace

Result<DescriptorSets> DescriptorSets::create(const Device& device, std::span<const Pipeline* const> pipelines,
                                              std::uint32_t copies) {
  DescriptorSets out;
  out.copies_ = copies;
  if (pipelines.empty()) return out;
  Counts counts = {};
  std::vector<VkDescriptorSetLayout> layouts;
  for (const Pipeline* pipeline : pipelines) {
    layouts.insert(layouts.end(), copies, pipeline->set_layout.get());
    for (const Binding& binding : std::span(pipeline->bindings).first(pipeline->binding_count)) {
      const auto type = std::find(kTypes.begin(), kTypes.end(), binding.type);
      if (type != kTypes.end()) counts[static_cast<std::size_t>(type - kTypes.begin())] += copies;
    }
  }
  TYNDALL_ASSIGN(out.pool_, create_pool(device, static_cast<std::uint32_t>(layouts.size()), counts));
  out.sets_.resize(layouts.size());
  TYNDALL_TRY(allocate_sets(device, out.pool_.get(), layouts, out.sets_.data()));
  return out;
}

void DescriptorArena::reset() {
  if (pools_.empty()) return;
  for (std::size_t i = 0; i <= current_; ++i) device_->vk.ResetDescriptorPool(device_->device, pools_[i].get(), 0);
  current_ = 0;
  used_ = 0;
}

Result<VkDescriptorSet> DescriptorArena::allocate(const Pipeline& pipeline) {
  // Every set fits, whatever its bindings are.
  constexpr std::uint32_t kSets = 32;
  constexpr Counts kRoom = {kSets * kMaxBindings, kSets * kMaxBindings, kSets * kMaxBindings, kSets * kMaxBindings};
  const std::size_t next = used_ == kSets ? current_ + 1 : current_;
  if (next == pools_.size()) {
    pools_.reserve(next + 1);
    TYNDALL_ASSIGN(Handle<VkDescriptorPool> pool, create_pool(*device_, kSets, kRoom));
    pools_.push_back(std::move(pool));
  }
  if (next != current_) used_ = 0;
  current_ = next;
  VkDescriptorSet set = VK_NULL_HANDLE;
  const VkDescriptorSetLayout layout = pipeline.set_layout.get();
  TYNDALL_TRY(allocate_sets(*device_, pools_[current_].get(), {&layout, 1}, &set));
  ++used_;
  return set;
}

void write_set(const Device& device, VkDescriptorSet set, const Pipeline& pipeline,
               std::span<const Descriptor* const> descriptors) {
  std::array<VkWriteDescriptorSet, kMaxBindings> writes = {};
  for (std::uint32_t i = 0; i < pipeline.binding_count; ++i) {
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = set;
    writes[i].dstBinding = pipeline.bindings[i].binding;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = pipeline.bindings[i].type;
    writes[i].pImageInfo = &descriptors[i]->image;
    writes[i].pBufferInfo = &descriptors[i]->buffer;
  }
  device.vk.UpdateDescriptorSets(device.device, pipeline.binding_count, writes.data(), 0, nullptr);
}

Result<void> write_set(const Device& device, VkDescriptorSet set, const Pipeline& pipeline,
                       std::span<const NamedResource> resources) {
  std::array<const Descriptor*, kMaxBindings> descriptors = {};
  for (std::uint32_t i = 0; i < pipeline.binding_count; ++i) {
    for (const NamedResource& resource : resources) {
      if (resource.name == pipeline.bindings[i].name) descriptors[i] = &resource;
    }
    if (descriptors[i] == nullptr) {
      return Error{ErrorCode::invalid_argument, std::string(pipeline.name) + ": nothing is bound to " +
                                                    std::string(pipeline.bindings[i].name) +
                                                    "; expected a resource of that name"};
    }
  }
  write_set(device, set, pipeline, std::span(descriptors).first(pipeline.binding_count));
  return {};
}

void bind(const Device& device, VkCommandBuffer cmd, const Pipeline& pipeline, VkDescriptorSet set, const void* push) {
  device.vk.CmdBindPipeline(cmd, pipeline.bind_point, pipeline.pipeline.get());
  if (pipeline.binding_count > 0) {
    device.vk.CmdBindDescriptorSets(cmd, pipeline.bind_point, pipeline.layout.get(), 0, 1, &set, 0, nullptr);
  }
  if (push != nullptr && pipeline.push_bytes > 0) {
    device.vk.CmdPushConstants(cmd, pipeline.layout.get(), pipeline.push_stages, 0, pipeline.push_bytes, push);
  }
}

Result<void> bind(DescriptorArena& sets, VkCommandBuffer cmd, const Pipeline& pipeline,
                  std::span<const NamedResource> resources, const void* push) {
  VkDescriptorSet set = VK_NULL_HANDLE;
  if (pipeline.binding_count > 0) {
    TYNDALL_ASSIGN(set, sets.allocate(pipeline));
    TYNDALL_TRY(write_set(sets.device(), set, pipeline, resources));
  }
  bind(sets.device(), cmd, pipeline, set, push);
  return {};
}

}  // namespace tyndall::gpu
