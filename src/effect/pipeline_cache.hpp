// The pipelines of the effect, found by shader and specialisation constants.
#pragma once

#include <span>
#include <vector>

#include "effect/step.hpp"
#include "gpu/pipeline.hpp"

namespace tyndall {

class PipelineCache {
 public:
  // `threads`: how many make() uses at most, the calling one included.
  void create(const gpu::Device& device, std::uint32_t threads) {
    device_ = &device;
    threads_ = threads;
  }

  // Makes the pipelines that are missing, at most `budget` of them, and returns how many were made. Each takes about
  // 0.05 s on a CPU device. After an error those that were made remain.
  Result<std::uint32_t> make(std::span<const PipelineKey> keys, std::uint32_t budget = UINT32_MAX);
  // Returns null for a pipeline that was not made. Neither allocates nor locks. The pointer is valid until the next
  // make().
  [[nodiscard]] const gpu::Pipeline* find(const PipelineKey& key) const;

 private:
  const gpu::Device* device_ = nullptr;
  std::uint32_t threads_ = 1;
  std::vector<PipelineKey> keys_;  // apart from the pipelines, so that a search touches little memory
  std::vector<gpu::Pipeline> pipelines_;
};

}  // namespace tyndall
