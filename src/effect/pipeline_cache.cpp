#include "effect/pipeline_cache.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "gpu/try.hpp"

namespace tyndall {

Result<std::uint32_t> PipelineCache::make(std::span<const PipelineKey> keys, std::uint32_t budget) {
  std::uint32_t made = 0;
  for (const PipelineKey& key : keys) {
    if (made == budget) break;
    if (find(key) != nullptr) continue;
    std::array<gpu::Constant, shared::kSpecialisationIds> constants = {};
    std::size_t count = 0;
    for (const std::uint32_t id : key.shader->constants) constants[count++] = {id, key.constants[id]};
    // Room first: an error must leave both lists of the same length.
    if (keys_.size() == keys_.capacity()) keys_.reserve(2 * keys_.size() + 16);
    pipelines_.reserve(keys_.capacity());
    TYNDALL_ASSIGN(gpu::Pipeline pipeline,
                   gpu::create_compute_pipeline(*device_, *key.shader, std::span(constants).first(count)));
    keys_.push_back(key);
    pipelines_.push_back(std::move(pipeline));
    ++made;
  }
  return made;
}

const gpu::Pipeline* PipelineCache::find(const PipelineKey& key) const {
  const auto found = std::find(keys_.begin(), keys_.end(), key);
  return found == keys_.end() ? nullptr : &pipelines_[static_cast<std::size_t>(found - keys_.begin())];
}

}  // namespace tyndall
