// Changes the settings of an effect: checks them, allocates what they need, and then replaces the old objects.
#include <utility>

#include "air/phase.hpp"
#include "effect/effect_state.hpp"
#include "effect/frame_steps.hpp"
#include "effect/limits.hpp"
#include "effect/modes.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

constexpr std::uint32_t bit(Affects affects) { return 1U << static_cast<std::uint32_t>(affects); }

// Returns whether two descriptions agree in the settings that can change after creation.
bool same_limits(const EffectDesc& a, const EffectDesc& b) {
  return a.max_extent.width == b.max_extent.width && a.max_extent.height == b.max_extent.height &&
         a.max_cascades == b.max_cascades && a.max_shadow_resolution == b.max_shadow_resolution &&
         a.shadow_colors == b.shadow_colors && a.clouds == b.clouds;
}

}  // namespace

Params Effect::State::drawn_with(const Params& p) const {
  Params out = p;
  const Params& built = tables.built(p);
  out.tables = built.tables;
  if (reads_tables(p.scattering)) out.scattering.color = built.scattering.color;
  return out;
}

Params Effect::State::table_params() const {
  Params out = params;
  const Params& built = tables.built(params);
  out.planet = built.planet;
  out.atmosphere = built.atmosphere;
  out.phase_table = built.phase_table;
  out.tables = built.tables;
  out.scattering.color = built.scattering.color;
  return out;
}

// Returns the mode with the largest buffers among those that frames with these parameters may have before and after the
// tables in progress are complete.
ColorMode Effect::State::color_of_buffers(const Params& p) const {
  return drawn_with(p).scattering.color == ColorMode::spectral ? ColorMode::spectral : p.scattering.color;
}

Result<void> Effect::State::make_pipelines(const EffectDesc& d, const Params& p) {
  TYNDALL_TRY(pipelines.make(pipelines_of_frames(d, p, target)));
  TYNDALL_TRY(sets.make(sets_of_frames(d, p, target), pipelines));
  return {};
}

Result<Effect::State::Pending> Effect::State::plan(const EffectDesc& d, const Params& p, std::uint32_t required) {
  const bool other_resources = (required & bit(Affects::Resources)) != 0;
  if ((required & kEverything) != 0) TYNDALL_TRY(check_limits(device, d, p));
  Pending pending = {d, p, {}, {}, ColorMode::rgb, {}, {}};
  if (other_resources || (required & bit(Affects::Pipeline)) != 0) {
    TYNDALL_TRY(make_pipelines(d, p));
    if (const Params before = drawn_with(p); before.scattering.color != p.scattering.color) {
      TYNDALL_TRY(make_pipelines(d, before));
    }
  }
  if (other_resources) {
    // Until tables at three channels are complete, frames are drawn with those at four wavelengths, whose buffers are
    // larger.
    Params larger = p;
    larger.scattering.color = pending.buffer_color = color_of_buffers(p);
    TYNDALL_ASSIGN(pending.buffers, buffers.plan(d, larger));
    TYNDALL_ASSIGN(pending.froxels, froxels.plan(d, p));
  }
  if ((required & bit(Affects::Tables)) != 0) {
    TYNDALL_ASSIGN(pending.tables, tables.plan(p));
    pending.phase = {phase_rows(p, ColorMode::rgb), phase_rows(p, ColorMode::spectral)};
  }
  return pending;
}

void Effect::State::commit(Pending&& pending) noexcept {
  if (pending.buffers) {
    buffers.commit(std::move(*pending.buffers), FrameRing::slots(desc) + 1);
    buffer_color = pending.buffer_color;
  }
  if (pending.froxels) froxels.commit(std::move(*pending.froxels), FrameRing::slots(desc) + 1);
  if (pending.tables) tables.commit(std::move(*pending.tables));
  const bool other_color = params.scattering.color != pending.params.scattering.color;
  const bool other_phase = air::tabulated(params.atmosphere) != air::tabulated(pending.params.atmosphere);
  const bool other_inputs = desc.shadow_colors != pending.desc.shadow_colors || desc.clouds != pending.desc.clouds;
  if (other_inputs || other_color || other_phase) all_pipelines.clear();
  if (pending.phase) phase = std::move(*pending.phase);
  desc = pending.desc;
  params = pending.params;
  served_revision = 0;
}

Result<void> Effect::State::change(const EffectDesc& d, const Params& p) {
  std::uint32_t required = affected(params, p);
  if ((required & bit(Affects::Everything)) != 0) required |= kEverything;
  if (!same_limits(desc, d) || color_of_buffers(p) != buffer_color) required |= bit(Affects::Resources);
  TYNDALL_ASSIGN(Pending pending, plan(d, p, required));
  commit(std::move(pending));
  return {};
}

Result<Progress> Effect::State::prepare_pipelines(std::uint32_t budget) {
  if (all_pipelines.empty()) all_pipelines = all_frame_pipelines(desc, target, params);
  TYNDALL_TRY(pipelines.make(all_pipelines, budget));
  Progress progress;
  progress.total = static_cast<std::uint32_t>(all_pipelines.size());
  for (const PipelineKey& key : all_pipelines) progress.done += pipelines.find(key) != nullptr ? 1 : 0;
  return progress;
}

}  // namespace tyndall
