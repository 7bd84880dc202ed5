// The descriptor sets of steps. Each slot (a view of a frame in flight, or a build of the tables) has a set for each
// shader and chosen resource, which the steps of the slot share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "effect/pipeline_cache.hpp"
#include "effect/step.hpp"
#include "gpu/descriptors.hpp"

namespace tyndall {

class SetCache {
 public:
  // A set of one slot. `written`: it refers to the resources of the commands that are being recorded.
  struct Set {
    VkDescriptorSet set = VK_NULL_HANDLE;
    bool written = false;
  };

  void create(const gpu::Device& device, std::uint32_t slots) {
    device_ = &device;
    slots_ = slots;
  }
  // Allocates the missing sets, all or none. `pipelines` contains the pipelines of their shaders, and outlives the
  // sets.
  Result<void> make(std::span<const SetKey> keys, const PipelineCache& pipelines);
  // To be called before the commands of a slot are recorded again, once the previous ones have completed. All sets of
  // the slot are then written again when they are first used. Comparing their resources with the previous ones would
  // not be enough, because a new image view can have the handle of one that the caller has destroyed.
  void begin(std::uint32_t slot);
  // Returns null if make() has not allocated the set. Neither allocates nor locks.
  [[nodiscard]] Set* find(const SetKey& key, std::uint32_t slot);

 private:
  const gpu::Device* device_ = nullptr;
  std::uint32_t slots_ = 0;
  std::vector<SetKey> keys_;
  std::vector<Set> sets_;  // slots_ per key
  std::vector<gpu::DescriptorSets> allocated_;
};

}  // namespace tyndall
