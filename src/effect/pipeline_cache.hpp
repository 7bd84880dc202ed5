// The pipelines of the effect, found by shader and specialisation constants.
#pragma once

#include <span>
#include <vector>

#include "effect/step.hpp"
#include "gpu/pipeline.hpp"

namespace tyndall {

class PipelineCache {
 public:
  // `threads`: maximum number of threads that make() uses, including the calling one.
  void create(const gpu::Device& device, std::uint32_t threads) {
    device_ = &device;
    threads_ = threads;
  }

  // Creates missing pipelines, at most `budget` of them, and returns their number. Each takes about 0.1 s on a CPU
  // device. Pipelines that were created before an error are retained.
  Result<std::uint32_t> make(std::span<const PipelineKey> keys, std::uint32_t budget = UINT32_MAX);
  // Returns null if the pipeline has not been created. Neither allocates nor locks. The pointer is valid until the next
  // call of make().
  [[nodiscard]] const gpu::Pipeline* find(const PipelineKey& key) const;
  // Returns any pipeline of a shader, or null. All pipelines of a shader have the same bindings.
  [[nodiscard]] const gpu::Pipeline* find(const gpu::Shader& shader) const;

 private:
  const gpu::Device* device_ = nullptr;
  std::uint32_t threads_ = 1;
  std::vector<PipelineKey> keys_;  // keys of pipelines_, in the same order; a search reads only these
  std::vector<gpu::Pipeline> pipelines_;
};

}  // namespace tyndall
