// What an Effect owns, and the steps that its public functions (effect_api.cpp) consist of.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "effect/epipolar.hpp"
#include "effect/frame_ring.hpp"
#include "effect/remarks.hpp"
#include "effect/tables.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/resource.hpp"
#include "gpu/timer.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

constexpr std::uint32_t kMaxTimedPasses = 40;

// Loads the functions of a device and checks that its limits suffice for every shader of the effect.
Result<void> open_device(gpu::Device& device, const DeviceInfo& info);
// Memory that an effect with these settings takes; see query_memory().
[[nodiscard]] MemoryUsage plan_memory(const gpu::Device& device, const EffectDesc& desc, const Params& params);

struct Effect::State {
  State() = default;
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  DeviceInfo info;
  EffectDesc desc;
  Params params;
  gpu::Device device;

  std::array<std::array<gpu::Pipeline, kModeCount>, 2> march_per_pixel;  // without and with colours; made when needed
  gpu::Pipeline no_air;
  Epipolar epipolar;
  TableBuilder tables;
  gpu::Image no_shadows, no_colors;
  gpu::Buffer constants;
  gpu::Buffer counters;           // written by shaders
  gpu::Buffer counters_readback;  // with EffectDesc::counters
  gpu::Handle<VkSampler> nearest;
  gpu::Handle<VkSampler> linear;
  gpu::Handle<VkSampler> shadow_compare;
  gpu::Handle<VkSampler> shadow_plain;  // the depths themselves, with the same border
  gpu::Handle<VkSampler> shadow_tint;
  FrameRing ring;
  Remarks remarks;
  gpu::Timer timer;
  std::array<PassTiming, kMaxTimedPasses> timings = {};
  std::array<ResourceMemory, kTableCount + kEpipolarBuffers + 3> resource_rows = {};

  bool images_ready = false;  // the first recording moves them out of the undefined layout

  // Everything that other settings need, allocated before any of it is taken over.
  struct Pending {
    EffectDesc desc;
    Params params;
    Epipolar::Pending epipolar;
    TableBuilder::Pending tables;
  };

  [[nodiscard]] std::byte* mapped(VkDeviceSize offset) const {
    return static_cast<std::byte*>(constants.mapped) + offset;
  }

  // Makes what never changes, and takes over `desc` and `params` of the state.
  Result<void> create_objects();
  // Checks other settings and allocates what they need. An error leaves what is drawn, the progress of the tables
  // and memory() as they were; pipelines that were made before it remain, so that the next attempt is faster.
  Result<Pending> plan(const EffectDesc& desc, const Params& params);
  // Takes over what was planned. Cannot fail.
  void commit(Pending&& pending) noexcept;
  // Plans and commits.
  Result<void> change(const EffectDesc& desc, const Params& params);

  Result<Progress> prepare_pipelines(std::uint32_t budget);
  Result<void> record(VkCommandBuffer cmd, const FrameInputs& inputs);
  [[nodiscard]] Counters read_counters(std::uint64_t frame_index, std::uint32_t view) const;
  [[nodiscard]] std::span<const ResourceMemory> list_resources();
  [[nodiscard]] MemoryUsage memory() const;
  [[nodiscard]] std::span<const PassTiming> read_timings(std::uint64_t frame_index, std::uint32_t view);

 private:
  Result<void> create_samplers();
  Result<void> make_march_per_pixel(bool colors, std::uint32_t mode);
  // The pipelines that record() needs with these settings, where missing. They are expensive to make.
  Result<void> make_pipelines(const EffectDesc& desc, const Params& params);
  void prepare_images(VkCommandBuffer cmd);
  void clear_counters(VkCommandBuffer cmd, VkDeviceSize offset);
  void copy_counters(VkCommandBuffer cmd, VkDeviceSize offset);
  Result<void> run(VkCommandBuffer cmd, const gpu::Pipeline& pipeline, std::span<const gpu::NamedResource> resources,
                   const void* push, VkExtent3D size);
};

}  // namespace tyndall
