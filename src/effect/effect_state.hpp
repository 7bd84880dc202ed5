// The state of an Effect, and the operations from which its public functions (effect_api.cpp) are composed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "effect/frame_buffers.hpp"
#include "effect/frame_parts.hpp"
#include "effect/frame_ring.hpp"
#include "effect/froxel_volume.hpp"
#include "effect/phase_rows.hpp"
#include "effect/pipeline_cache.hpp"
#include "effect/remarks.hpp"
#include "effect/set_cache.hpp"
#include "effect/step_recorder.hpp"
#include "effect/tables.hpp"
#include "gpu/resource.hpp"
#include "gpu/timer.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

constexpr std::uint32_t kMaxTimedPasses = 48;

// Loads the functions of a device and checks that its limits suffice for every shader of the effect.
Result<void> open_checked_device(gpu::Device& device, const DeviceInfo& info);
// Returns the memory that an effect with these settings allocates; see query_memory().
[[nodiscard]] MemoryUsage plan_memory(const gpu::Device& device, const EffectDesc& desc, const Params& params);

// Not exported by the shared library, unlike Effect.
struct TYNDALL_HIDDEN Effect::State {
  explicit State(std::shared_ptr<SharedTables> of) : shared_tables(std::move(of)), tables(shared_tables->builder) {}
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  DeviceInfo info;
  EffectDesc desc;
  Params params;
  std::array<PhaseRows, 2> phase;  // rows of `params` with scattering.color = rgb, and with spectral
  gpu::Device device;
  Target target = Target::cpu;  // the kind of device for which the passes of a frame are chosen

  PipelineCache pipelines;
  SetCache sets;                           // descriptor sets of frames, with the slots of `ring`
  std::vector<PipelineKey> all_pipelines;  // all that prepare_pipelines() makes; empty until it is called
  FrameBuffers buffers;
  FroxelVolume froxels;
  std::shared_ptr<SharedTables> shared_tables;
  TableBuilder& tables;
  std::uint64_t served_revision = 0;  // revision of the tables for which TableBuilder::serves() was last true
  gpu::Image no_shadows, no_colors, no_clouds;
  gpu::Buffer constants;
  gpu::Buffer counters;           // written by shaders
  gpu::Buffer counters_readback;  // copy for the host, with EffectDesc::counters
  gpu::Handle<VkSampler> nearest;
  gpu::Handle<VkSampler> linear;
  gpu::Handle<VkSampler> shadow_compare;
  gpu::Handle<VkSampler> shadow_plain;  // without comparison, with the same border
  gpu::Handle<VkSampler> shadow_tint;
  FrameRing ring;
  FrameParts parts;
  Remarks remarks;
  gpu::Timer timer;
  std::array<PassTiming, kMaxTimedPasses> timings = {};
  std::array<ResourceMemory, kTableCount + kFrameBuffers + FroxelVolume::kImages + 4> resource_rows = {};

  ColorMode buffer_color = ColorMode::rgb;  // representation of light for which `buffers` are large enough
  bool images_ready = false;                // false until the first recording, which changes their undefined layout

  // The objects that new settings need. They are all allocated before commit() replaces any old ones.
  struct Pending {
    EffectDesc desc;
    Params params;
    std::optional<std::array<PhaseRows, 2>> phase;
    std::optional<FrameBuffers::Pending> buffers;
    ColorMode buffer_color = ColorMode::rgb;  // representation of light for which `buffers` are large enough
    std::optional<FroxelVolume::Pending> froxels;
    std::optional<TableBuilder::Pending> tables;
  };

  [[nodiscard]] std::byte* mapped(VkDeviceSize offset) const {
    return static_cast<std::byte*>(constants.mapped) + offset;
  }

  // Creates the objects that do not depend on settings, and all others.
  Result<void> create_objects();
  // The mask with which plan() prepares everything that it can.
  static constexpr std::uint32_t kEverything =
      1U << static_cast<std::uint32_t>(Affects::Resources) | 1U << static_cast<std::uint32_t>(Affects::Tables);
  // Checks new settings and allocates the objects that they need, as far as `required` (a mask of bits 1 << Affects)
  // contains them. After an error, the picture, the progress of the tables and memory() are unchanged. Pipelines and
  // descriptor sets that were already created are retained, so the next attempt is faster.
  Result<Pending> plan(const EffectDesc& desc, const Params& params, std::uint32_t required);
  // Replaces the objects by those of plan(). Cannot fail.
  void commit(Pending&& pending) noexcept;
  // Calls plan() and commit().
  Result<void> change(const EffectDesc& desc, const Params& params);

  Result<Progress> prepare_pipelines(std::uint32_t budget);
  Result<void> record(VkCommandBuffer cmd, const FrameInputs& inputs, FramePart part);
  [[nodiscard]] Counters read_counters(std::uint64_t frame_index, std::uint32_t view) const;
  [[nodiscard]] std::span<const ResourceMemory> list_resources();
  [[nodiscard]] MemoryUsage memory() const;
  [[nodiscard]] std::span<const PassTiming> read_timings(std::uint64_t frame_index, std::uint32_t view);
  // Returns the parameters with which frames are drawn: `p`, but with the tables.* of the tables in use and, if frames
  // read the tables, with the scattering.color for which they were built.
  [[nodiscard]] Params drawn_with(const Params& p) const;
  // Returns tyndall::table_params().
  [[nodiscard]] Params table_params() const;
  // Returns an error if other effects have set other parameters for the tables, so that table_key() and table_bytes()
  // are not those of the tables.
  [[nodiscard]] Result<void> check_tables_wanted(const char* where) const;
  // Writes the rows of a tabulated phase function into `block`, behind the medium. Does nothing for other functions.
  void write_phase(std::byte* block, ColorMode color) const;

 private:
  [[nodiscard]] ColorMode color_of_buffers(const Params& p) const;
  Result<void> create_samplers();
  // Creates the tables, or checks those of another effect. Becomes a user of them.
  Result<void> create_tables();
  // Returns an error if other effects have changed the tables, so that they do not belong to `params`.
  Result<void> check_tables();
  Result<void> make_pipelines(const EffectDesc& d, const Params& p);
  void prepare_images(VkCommandBuffer cmd);
  void drop(VkCommandBuffer cmd, const FrameInputs& inputs);
  // Does what precedes the steps of a frame: checks the inputs, and writes the constants.
  Result<void> begin_frame(VkCommandBuffer cmd, const FrameInputs& inputs, const Params& drawn);
  // Writes the constants of a frame into its slot of the ring.
  void write_constants(const FrameInputs& inputs, const Params& drawn, const shared::FrameConstants& frame,
                       std::uint32_t slot);
  [[nodiscard]] BoundResources bind_resources(const FrameInputs& inputs, std::uint32_t slot) const;
};

}  // namespace tyndall
