#include "effect/pipeline_cache.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <optional>
#include <thread>
#include <utility>

#include "gpu/guard.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

// Returns the format of the output, if the shader writes it.
std::optional<gpu::StorageFormat> output_format(const PipelineKey& key) {
  for (const gpu::Binding& binding : key.shader->bindings) {
    if (binding.name != name_of(Resource::output_color)) continue;
    const bool floats = key.constants[shared::kFloatOutputId] != 0;
    return gpu::StorageFormat{binding.binding, floats ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT};
  }
  return {};
}

Result<gpu::Pipeline> create_pipeline(const gpu::Device& device, const PipelineKey& key) {
  std::array<gpu::Constant, shared::kSpecialisationIds> constants = {};
  std::size_t count = 0;
  for (const std::uint32_t id : key.shader->constants) constants[count++] = {id, key.constants[id]};
  return gpu::create_compute_pipeline(device, *key.shader, std::span(constants).first(count), output_format(key));
}

// Runs `work` on the calling thread and on up to `others` additional threads, as many as can be started.
template <typename Work>
void run_on_threads(std::size_t others, const Work& work) {
  std::vector<std::jthread> threads;
  threads.reserve(others);
  for (std::size_t i = 0; i < others; ++i) {
    try {
      threads.emplace_back(work);
    } catch (const std::exception&) {
      break;
    }
  }
  work();
}

}  // namespace

Result<std::uint32_t> PipelineCache::make(std::span<const PipelineKey> keys, std::uint32_t budget) {
  std::vector<PipelineKey> missing;
  for (const PipelineKey& key : keys) {
    if (missing.size() == budget) break;
    if (find(key) == nullptr && std::find(missing.begin(), missing.end(), key) == missing.end()) missing.push_back(key);
  }
  if (missing.empty()) return 0;
  // Reserved first, because nothing may fail between the creation of a pipeline and its insertion into the lists.
  keys_.reserve(keys_.size() + missing.size());
  pipelines_.reserve(keys_.capacity());
  std::vector<std::optional<Result<gpu::Pipeline>>> made(missing.size());

  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  run_on_threads(std::min<std::size_t>(threads_, missing.size()) - 1, [&]() noexcept {
    for (std::size_t i = next++; i < missing.size() && !failed; i = next++) {
      made[i] = guarded("creating a pipeline", [&] { return create_pipeline(*device_, missing[i]); });
      if (!made[i]->ok()) failed = true;
    }
  });

  std::optional<Error> error;
  for (std::size_t i = 0; i < missing.size(); ++i) {
    if (!made[i]) continue;
    if (!made[i]->ok()) {
      if (!error) error = made[i]->error();
      continue;
    }
    keys_.push_back(missing[i]);
    pipelines_.push_back(std::move(*made[i]).value());
  }
  if (error) return *std::move(error);
  return static_cast<std::uint32_t>(missing.size());
}

const gpu::Pipeline* PipelineCache::find(const PipelineKey& key) const {
  const auto found = std::find(keys_.begin(), keys_.end(), key);
  return found == keys_.end() ? nullptr : &pipelines_[static_cast<std::size_t>(found - keys_.begin())];
}

const gpu::Pipeline* PipelineCache::find(const gpu::Shader& shader) const {
  const auto found =
      std::find_if(keys_.begin(), keys_.end(), [&](const PipelineKey& k) { return k.shader == &shader; });
  return found == keys_.end() ? nullptr : &pipelines_[static_cast<std::size_t>(found - keys_.begin())];
}

}  // namespace tyndall
