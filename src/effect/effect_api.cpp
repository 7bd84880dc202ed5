// The public functions of Effect. They check the preconditions that all of them have, and turn exceptions into errors.
#include <utility>

#include "effect/effect_state.hpp"
#include "effect/frame_constants.hpp"
#include "effect/limits.hpp"
#include "gpu/guard.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

// Calls body(state) in guarded(). Returns an error for an effect that was moved from, because it has no state.
template <typename State, typename Body>
std::invoke_result_t<Body, State&> call(const std::unique_ptr<State>& state, const char* where, Body&& body) noexcept {
  return guarded(where, [&]() -> std::invoke_result_t<Body, State&> {
    if (state) return body(*state);
    return Error{ErrorCode::invalid_argument, std::string(where) +
                                                  ": this Effect has been moved from; expected one that "
                                                  "create() returned"};
  });
}

// Calls body(state) like call(), for functions that record into `cmd`. Returns an error if `cmd` is null.
template <typename State, typename Body>
std::invoke_result_t<Body, State&> record_with(const std::unique_ptr<State>& state, const char* where,
                                               VkCommandBuffer cmd, Body&& body) noexcept {
  return call(state, where, [&](State& s) -> std::invoke_result_t<Body, State&> {
    if (cmd != VK_NULL_HANDLE) return body(s);
    return Error{ErrorCode::invalid_argument, std::string(where) + ": the command buffer is null; expected one that is "
                                                                   "being recorded"};
  });
}

}  // namespace

Requirements requirements() { return {VK_API_VERSION_1_3, {}}; }

Effect::Effect(std::unique_ptr<State> state) : state_(std::move(state)) {}
Effect::Effect(Effect&&) noexcept = default;
Effect& Effect::operator=(Effect&&) noexcept = default;
Effect::~Effect() = default;

Result<MemoryUsage> query_memory(const DeviceInfo& info, const EffectDesc& desc, const Params& params) {
  return guarded("query_memory", [&]() -> Result<MemoryUsage> {
    TYNDALL_TRY(check_desc(info, desc));
    TYNDALL_TRY(check_params(params));
    gpu::Device device;
    TYNDALL_TRY(open_checked_device(device, info));
    TYNDALL_TRY(check_limits(device, desc, params));
    return plan_memory(device, desc, params);
  });
}

Result<Effect> Effect::create(const DeviceInfo& info, const EffectDesc& desc, const Params& params) {
  return guarded("Effect::create", [&]() -> Result<Effect> {
    TYNDALL_TRY(check_desc(info, desc));
    TYNDALL_TRY(check_params(params));
    if (desc.tables_of != nullptr && !desc.tables_of->state_) {
      return Error{
          ErrorCode::invalid_argument,
          "Effect::create: EffectDesc::tables_of has been moved from; expected an effect that create() returned"};
    }
    auto state = std::make_unique<State>(desc.tables_of != nullptr ? desc.tables_of->state_->shared_tables
                                                                   : std::make_shared<SharedTables>());
    state->info = info;
    state->desc = desc;
    state->desc.tables_of = nullptr;
    state->params = params;
    TYNDALL_TRY(open_checked_device(state->device, info));
    TYNDALL_TRY(state->create_objects());
    return Effect(std::move(state));
  });
}

Result<void> Effect::set_params(const Params& params, const std::optional<EffectDesc>& desc) {
  return call(state_, "Effect::set_params", [&](State& s) -> Result<void> {
    if (desc) {
      TYNDALL_TRY(check_desc(s.info, *desc));
      TYNDALL_TRY(check_same_desc(s.desc, *desc));
    }
    TYNDALL_TRY(check_params(params));
    TYNDALL_TRY(s.tables.users().check_between("Effect::set_params"));
    EffectDesc wanted = desc.value_or(s.desc);
    wanted.tables_of = nullptr;
    return s.change(wanted, params);
  });
}

Result<Progress> Effect::prepare_pipelines(std::uint32_t budget) {
  return call(state_, "Effect::prepare_pipelines", [&](State& s) { return s.prepare_pipelines(budget); });
}

Result<void> Effect::set_shadow_colors(bool shadow_colors) {
  return call(state_, "Effect::set_shadow_colors", [&](State& s) -> Result<void> {
    TYNDALL_TRY(s.parts.check_between("Effect::set_shadow_colors"));
    EffectDesc desc = s.desc;
    desc.shadow_colors = shadow_colors;
    return s.change(desc, s.params);
  });
}

Result<void> Effect::set_limits(VkExtent2D max_extent, std::uint32_t max_cascades,
                                std::uint32_t max_shadow_resolution) {
  return call(state_, "Effect::set_limits", [&](State& s) -> Result<void> {
    EffectDesc desc = s.desc;
    desc.max_extent = max_extent;
    desc.max_cascades = max_cascades;
    desc.max_shadow_resolution = max_shadow_resolution;
    TYNDALL_TRY(check_desc(s.info, desc));
    TYNDALL_TRY(s.parts.check_between("Effect::set_limits"));
    return s.change(desc, s.params);
  });
}

const EffectDesc& Effect::desc() const {
  static constexpr EffectDesc kDefaults;
  return state_ ? state_->desc : kDefaults;
}

const Params& Effect::params() const {
  static const Params kDefaults;
  return state_ ? state_->params : kDefaults;
}

Progress Effect::precompute_progress() const { return state_ ? state_->tables.progress() : Progress{}; }

Result<Progress> Effect::record_precompute(VkCommandBuffer cmd, std::uint32_t budget) {
  return record_with(state_, "Effect::record_precompute", cmd, [&](State& s) -> Result<Progress> {
    TYNDALL_TRY(s.tables.users().check_between("Effect::record_precompute"));
    TYNDALL_TRY(s.tables.record(cmd, budget));
    return s.tables.progress();
  });
}

Result<void> Effect::record(VkCommandBuffer cmd, const FrameInputs& inputs, FramePart part) {
  return record_with(state_, "Effect::record", cmd, [&](State& s) { return s.record(cmd, inputs, part); });
}

Result<void> Effect::record_save_tables(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset) {
  return record_with(state_, "Effect::record_save_tables", cmd, [&](State& s) -> Result<void> {
    TYNDALL_TRY(s.check_tables_wanted("Effect::record_save_tables"));
    return s.tables.record_save(cmd, buffer, offset);
  });
}

Result<void> Effect::record_load_tables(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset) {
  return record_with(state_, "Effect::record_load_tables", cmd, [&](State& s) -> Result<void> {
    TYNDALL_TRY(s.tables.users().check_between("Effect::record_load_tables"));
    TYNDALL_TRY(s.check_tables_wanted("Effect::record_load_tables"));
    return s.tables.record_load(cmd, buffer, offset);
  });
}

std::string Effect::table_key() const {
  Result<std::string> key = call(state_, "Effect::table_key", [](State& s) -> Result<std::string> {
    return tyndall::table_key(s.device, s.params);
  });
  return key ? std::move(key).value() : std::string();
}

VkDeviceSize Effect::table_bytes() const { return state_ ? tyndall::table_bytes(state_->params) : 0; }

Params table_params(const Effect& effect) { return effect.state_ ? effect.state_->table_params() : Params{}; }

ColorMode picture_color(const Effect& effect) {
  return effect.state_ ? effect.state_->drawn_with(effect.state_->params).scattering.color : ColorMode::rgb;
}

LightTables Effect::light_tables() const {
  if (!state_) return {};
  const TableBuilder& tables = state_->tables;
  return {tables.table(TableId::sun_transmittance).view.get(), tables.table(TableId::sky_irradiance).view.get()};
}

ScatteringTables Effect::scattering_tables() const {
  if (!state_) return {};
  const auto table = [this](TableId id) -> Table {
    const gpu::Image& image = state_->tables.table(id);
    return {image.image.get(), image.view.get(), image.desc.extent};
  };
  return {table(TableId::single_rayleigh), table(TableId::single_mie), table(TableId::high_orders)};
}

MemoryUsage Effect::memory() const { return state_ ? state_->memory() : MemoryUsage{}; }

std::span<const ResourceMemory> Effect::resources() {
  return state_ ? state_->list_resources() : std::span<const ResourceMemory>();
}

Counters Effect::counters(std::uint64_t frame_index, std::uint32_t view) const {
  return state_ ? state_->read_counters(frame_index, view) : Counters{};
}

std::span<const PassTiming> Effect::timings(std::uint64_t frame_index, std::uint32_t view) {
  return state_ ? state_->read_timings(frame_index, view) : std::span<const PassTiming>();
}

std::span<const PassTiming> Effect::precompute_timings() {
  return state_ ? state_->tables.stage_times() : std::span<const PassTiming>();
}

}  // namespace tyndall
