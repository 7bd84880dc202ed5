// A small effect on the fake device, and its state that a failed call must not change.
#pragma once

#include <cstdint>
#include <string>

#include "effect_frame.hpp"
#include "faults.hpp"

namespace tyndall {

inline Params small_params() {
  Params params;
  params.tables.size = {8, 16, 16, 4};
  params.tables.orders = 2;
  params.epipolar.slices = 64;
  params.epipolar.samples = 64;
  return params;
}

// Returns parameters with other tables, buffers and pipelines.
inline Params other_params() {
  Params params = small_params();
  params.tables.size = {4, 8, 12, 4};
  params.atmosphere.aerosol_density = 2.0F;
  params.epipolar.slices = 40;
  params.epipolar.refinement_threshold = 0.5F;
  params.shadows.cascade_processing = CascadeProcessing::multi_pass;
  params.scattering.multiple = MultipleScattering::occluded;
  params.scattering.downscale = 2;
  return params;
}

inline EffectDesc small_desc() {
  EffectDesc desc;
  desc.max_extent = {64, 32};
  desc.output_format = OutputFormat::rgba32f;
  desc.max_shadow_resolution = 64;
  desc.timings = true;
  desc.counters = true;
  return desc;
}

template <typename Handle>
Handle number(std::uintptr_t n) {
  return reinterpret_cast<Handle>(n);
}
const inline auto kCommands = number<VkCommandBuffer>(7);

inline FrameInputs fake_frame() {
  static const Cascade cascades[2] = {{{}, 0.0F, 100.0F}, {{}, 100.0F, 1000.0F}};
  FrameInputs inputs;
  inputs.extent = {64, 32};
  inputs.color.view = number<VkImageView>(1000001);
  inputs.depth.view = number<VkImageView>(1000002);
  inputs.shadow_maps.view = number<VkImageView>(1000003);
  inputs.output.view = number<VkImageView>(1000004);
  inputs.shadow_resolution = 64;
  inputs.cascades = cascades;
  inputs.camera.clip_from_view = {{1.0F, 0, 0, 0, 0, -1.0F, 0, 0, 0, 0, 0, -1, 0, 0, 0.1F, 0}};
  return inputs;
}

// The state that a failed call must not change.
struct Observed {
  std::size_t frame_commands = 0;
  std::size_t objects = 0;
  MemoryUsage memory;
  Progress progress;
  Params params;
  VkImageView light = VK_NULL_HANDLE;
};

inline std::size_t commands_of_frame(Effect& effect) {
  faults::forget_commands();
  EXPECT_OK(effect.record(kCommands, fake_frame()));
  return faults::command_hash();
}

inline Observed observe(Effect& effect) {
  Observed out;
  out.objects = faults::live_objects();
  out.memory = effect.memory();
  out.progress = effect.precompute_progress();
  out.params = effect.params();
  out.light = effect.light_tables().sun_transmittance;
  out.frame_commands = commands_of_frame(effect);
  return out;
}

inline void expect_same(const Observed& a, const Observed& b, const std::string& where) {
  EXPECT_EQ(a.frame_commands, b.frame_commands) << where;
  EXPECT_EQ(a.objects, b.objects) << where;
  EXPECT_EQ(a.memory.persistent, b.memory.persistent) << where;
  EXPECT_EQ(a.memory.transient, b.memory.transient) << where;
  EXPECT_EQ(a.memory.host, b.memory.host) << where;
  EXPECT_EQ(a.progress.done, b.progress.done) << where;
  EXPECT_EQ(a.progress.total, b.progress.total) << where;
  EXPECT_EQ(affected(a.params, b.params), 0U) << where;
  EXPECT_EQ(a.light, b.light) << where;
}

enum class Built { not_at_all, in_part, completely, others_in_part };  // state of the tables

// Creates an effect on the fake device, and records frames until no objects wait to be freed.
inline Effect make(Built built) {
  Result<Effect> made = Effect::create(faults::fake_device(), small_desc(), small_params());
  EXPECT_OK(made);
  Effect effect = std::move(made).value();
  if (built != Built::not_at_all) {
    EXPECT_OK(effect.record_precompute(kCommands, built == Built::in_part ? 5 : UINT32_MAX));
  }
  if (built == Built::others_in_part) {
    EXPECT_OK(effect.set_params(other_params()));
    EXPECT_OK(effect.record_precompute(kCommands, 5));
  }
  for (int frame = 0; frame < 4; ++frame) commands_of_frame(effect);
  return effect;
}

}  // namespace tyndall
