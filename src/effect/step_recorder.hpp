// Records steps into a command buffer: the barrier, label, timing, bindings and command of each step.
#pragma once

#include <array>

#include "effect/pipeline_cache.hpp"
#include "effect/set_cache.hpp"
#include "effect/step.hpp"
#include "gpu/timer.hpp"

namespace tyndall {

// The Vulkan objects of the resources in one frame or build. Resources that no step uses are null.
struct BoundResources {
  std::array<gpu::Descriptor, kResources> list = {};

  void set(Resource resource, VkBuffer buffer, VkDeviceSize offset = 0, VkDeviceSize size = VK_WHOLE_SIZE) {
    list[index_of(resource)].buffer = {buffer, offset, size};
  }
  void set(Resource resource, VkImageView view, VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL,
           VkSampler sampler = VK_NULL_HANDLE) {
    list[index_of(resource)].image = {sampler, view, layout};
  }
  [[nodiscard]] const gpu::Descriptor& operator[](Resource resource) const { return list[index_of(resource)]; }
};

// Records steps. It allocates nothing, except for the message of an error.
class StepRecorder {
 public:
  // Binds the sets of `slot` from `sets`; a set that has not been written is first written with `resources`. `timer`
  // measures the dispatches and may be null. All arguments must outlive the recorder.
  StepRecorder(const gpu::Device& device, VkCommandBuffer cmd, const PipelineCache& pipelines, SetCache& sets,
               std::uint32_t slot, const BoundResources& resources, gpu::Timer* timer)
      : device_(device),
        cmd_(cmd),
        pipelines_(pipelines),
        sets_(sets),
        slot_(slot),
        resources_(resources),
        timer_(timer) {}

  // See HazardTracker::assume().
  void assume(Resource resource, VkAccessFlags access) { hazards_.assume(resource, access); }
  // Records a step. Returns an error if a pipeline, a descriptor set or a resource is missing.
  Result<void> record(const Step& step);

 private:
  Result<void> dispatch(const Step& step);
  Result<void> write(const Step& step, const gpu::Pipeline& pipeline, SetCache::Set& set);
  void transfer(const Step& step);
  void barrier_before(const Step& step);

  const gpu::Device& device_;
  VkCommandBuffer cmd_;
  const PipelineCache& pipelines_;
  SetCache& sets_;
  std::uint32_t slot_;
  const BoundResources& resources_;
  gpu::Timer* timer_;
  HazardTracker hazards_;
};

}  // namespace tyndall
