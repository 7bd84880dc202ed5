#include "effect/set_cache.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "gpu/try.hpp"

namespace tyndall {

Result<void> SetCache::make(std::span<const SetKey> keys, const PipelineCache& pipelines) {
  std::vector<SetKey> missing;
  std::vector<const gpu::Pipeline*> of_missing;
  for (const SetKey& key : keys) {
    if (std::find(keys_.begin(), keys_.end(), key) != keys_.end()) continue;
    if (std::find(missing.begin(), missing.end(), key) != missing.end()) continue;
    const gpu::Pipeline* pipeline = pipelines.find(*key.shader);
    if (pipeline == nullptr) {
      return Error{ErrorCode::invalid_argument, std::string("there is no pipeline of the shader ") + key.shader->name};
    }
    missing.push_back(key);
    of_missing.push_back(pipeline);
  }
  if (missing.empty()) return {};
  // Reserved first, because nothing may fail between the allocation of the sets and their insertion into the lists.
  keys_.reserve(keys_.size() + missing.size());
  sets_.reserve(keys_.capacity() * slots_);
  allocated_.reserve(allocated_.size() + 1);
  TYNDALL_ASSIGN(gpu::DescriptorSets made, gpu::DescriptorSets::create(*device_, of_missing, slots_));
  for (std::size_t i = 0; i < missing.size(); ++i) {
    keys_.push_back(missing[i]);
    for (std::uint32_t slot = 0; slot < slots_; ++slot) sets_.push_back({made.get(i, slot), false});
  }
  allocated_.push_back(std::move(made));
  return {};
}

void SetCache::begin(std::uint32_t slot) {
  for (std::size_t i = slot; i < sets_.size(); i += slots_) sets_[i].written = false;
}

SetCache::Set* SetCache::find(const SetKey& key, std::uint32_t slot) {
  const auto found = std::find(keys_.begin(), keys_.end(), key);
  if (found == keys_.end()) return nullptr;
  return &sets_[static_cast<std::size_t>(found - keys_.begin()) * slots_ + slot];
}

}  // namespace tyndall
