// Descriptor sets. DescriptorSets allocates all of its sets in advance, so that recording allocates nothing.
// DescriptorArena allocates a set for each bind, for command buffers whose binds are not known in advance.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "gpu/pipeline.hpp"

namespace tyndall::gpu {

// The resource of a binding: a buffer or an image.
struct Descriptor {
  VkDescriptorImageInfo image = {};
  VkDescriptorBufferInfo buffer = {};
};

// A resource with the name of its binding in GLSL.
struct NamedResource : Descriptor {
  std::string_view name;
};
[[nodiscard]] inline NamedResource named_buffer(std::string_view name, VkBuffer buffer, VkDeviceSize offset = 0,
                                                VkDeviceSize size = VK_WHOLE_SIZE) {
  return {{{}, {buffer, offset, size}}, name};
}
[[nodiscard]] inline NamedResource named_image(std::string_view name, VkImageView view,
                                               VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL,
                                               VkSampler sampler = VK_NULL_HANDLE) {
  return {{{sampler, view, layout}, {}}, name};
}

// Sets for known pipelines. A pipeline with the same bindings can be bound with the same set.
class DescriptorSets {
 public:
  // Allocates `copies` sets for each pipeline, all or none. The pipelines must outlive the sets.
  static Result<DescriptorSets> create(const Device& device, std::span<const Pipeline* const> pipelines,
                                       std::uint32_t copies = 1);
  [[nodiscard]] VkDescriptorSet get(std::size_t pipeline, std::uint32_t copy = 0) const {
    return sets_[pipeline * copies_ + copy];
  }

 private:
  Handle<VkDescriptorPool> pool_;
  std::vector<VkDescriptorSet> sets_;
  std::uint32_t copies_ = 0;
};

// The sets of one command buffer at a time.
class DescriptorArena {
 public:
  void create(const Device& device) { device_ = &device; }
  // Makes all sets available again. The commands that use them must have completed.
  void reset();
  // Returns a set for the pipeline, and allocates memory if there is no room.
  Result<VkDescriptorSet> allocate(const Pipeline& pipeline);
  [[nodiscard]] const Device& device() const { return *device_; }

 private:
  const Device* device_ = nullptr;
  std::vector<Handle<VkDescriptorPool>> pools_;  // equal ones, each with room for several pipelines
  std::size_t current_ = 0;                      // the pool in use
  std::uint32_t used_ = 0;                       // its sets in use
};

// Points a set to one resource per binding, in the order of Pipeline::bindings. No command buffer that is being
// recorded or executed may use the set. Allocates nothing.
// Precondition: there are as many descriptors as bindings, and none is null.
void write_set(const Device& device, VkDescriptorSet set, const Pipeline& pipeline,
               std::span<const Descriptor* const> descriptors);
// Points a set to the resources that have the names of its bindings. Returns an error if `resources` lacks a name, and
// then changes nothing.
Result<void> write_set(const Device& device, VkDescriptorSet set, const Pipeline& pipeline,
                       std::span<const NamedResource> resources);

// Binds the pipeline with its set, and pushes its constants. Allocates nothing.
void bind(const Device& device, VkCommandBuffer cmd, const Pipeline& pipeline, VkDescriptorSet set, const void* push);
// Binds the pipeline with a set of the arena that refers to `resources`. Returns an error if they lack a binding.
Result<void> bind(DescriptorArena& sets, VkCommandBuffer cmd, const Pipeline& pipeline,
                  std::span<const NamedResource> resources, const void* push = nullptr);

}  // namespace tyndall::gpu
