// The functions of the effect in C. Each checks its pointers and structures and calls the function of C++.
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <span>

#include "c/convert.hpp"
#include "c/error.hpp"
#include "c/handles.hpp"
#include "c/params.hpp"
#include "c/structures.hpp"
#include "gpu/try.hpp"

namespace tyndall::c {
namespace {

// Calls body(Effect&, where) in call(), for an effect that is not null.
template <typename Handle, typename Body>
TyndallStatus with(Handle* effect, const char* where, Body&& body) noexcept {
  return call(where, [&](const char* function) -> Result<void> {
    TYNDALL_TRY(check_pointer(function, "effect", effect));
    return body(*effect->effect, function);
  });
}

// Writes *out unless it is null.
void write_progress(const Progress& progress, TyndallProgress* out) {
  if (out != nullptr) *out = to_c(progress);
}

// Returns `from` as the functions for arrays do; see tyndall_effect_resources().
template <typename C, typename Cpp>
Result<void> write_array(std::span<const Cpp> from, uint32_t* count, C* out) {
  const auto all = static_cast<uint32_t>(from.size());
  if (out != nullptr) {
    for (uint32_t i = 0; i < std::min(all, *count); ++i) out[i] = to_c(from[i]);
  }
  *count = all;
  return {};
}

Result<EffectDesc> read_desc(const char* where, const TyndallEffectDesc* desc) {
  TYNDALL_ASSIGN(const TyndallEffectDesc read_c, read(where, desc, to_c(EffectDesc{})));
  return to_cpp(read_c);
}

const Params& params_or_defaults(const TyndallParams* params) {
  static const Params kDefaults;
  return params != nullptr ? params->params : kDefaults;
}

}  // namespace
}  // namespace tyndall::c

using namespace tyndall;

TyndallStatus tyndall_device_info_defaults(TyndallDeviceInfo* info, size_t struct_size) {
  return c::call(__func__,
                 [&](const char* where) { return c::write_defaults(where, c::to_c(DeviceInfo{}), info, struct_size); });
}

TyndallStatus tyndall_effect_desc_defaults(TyndallEffectDesc* desc, size_t struct_size) {
  return c::call(__func__,
                 [&](const char* where) { return c::write_defaults(where, c::to_c(EffectDesc{}), desc, struct_size); });
}

TyndallStatus tyndall_frame_inputs_defaults(TyndallFrameInputs* inputs, size_t struct_size) {
  return c::call(__func__, [&](const char* where) {
    return c::write_defaults(where, c::to_c(FrameInputs{}), inputs, struct_size);
  });
}

TyndallStatus tyndall_atmosphere_inputs_defaults(TyndallAtmosphereInputs* inputs, size_t struct_size) {
  return c::call(__func__, [&](const char* where) {
    return c::write_defaults(where, c::to_c(AtmosphereInputs{}), inputs, struct_size);
  });
}

TyndallStatus tyndall_atmosphere_constants(const TyndallParams* params, const TyndallAtmosphereInputs* inputs,
                                           void* constants, size_t size) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "constants", constants));
    TYNDALL_ASSIGN(const TyndallAtmosphereInputs read, c::read(where, inputs, c::to_c(AtmosphereInputs{})));
    TYNDALL_ASSIGN(const AtmosphereConstants made,
                   atmosphere_constants(c::params_or_defaults(params), c::to_cpp(read)));
    static_assert(sizeof made == TYNDALL_ATMOSPHERE_CONSTANTS_SIZE);
    if (size != sizeof made) {
      return c::invalid(where, "'size' is " + std::to_string(size) + "; expected TYNDALL_ATMOSPHERE_CONSTANTS_SIZE, " +
                                   std::to_string(sizeof made));
    }
    std::memcpy(constants, &made, sizeof made);
    return {};
  });
}

TyndallStatus tyndall_query_memory(const TyndallDeviceInfo* info, const TyndallEffectDesc* desc,
                                   const TyndallParams* params, TyndallMemoryUsage* memory) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_ASSIGN(const TyndallDeviceInfo callbacks, c::read(where, info, TyndallDeviceInfo{}));
    TYNDALL_ASSIGN(const EffectDesc cpp_desc, c::read_desc(where, desc));
    TYNDALL_ASSIGN(const MemoryUsage usage,
                   query_memory(c::to_cpp(callbacks), cpp_desc, c::params_or_defaults(params)));
    return c::write(where, c::to_c(usage), memory);
  });
}

TyndallStatus tyndall_effect_create(const TyndallDeviceInfo* info, const TyndallEffectDesc* desc,
                                    const TyndallParams* params, TyndallEffect** effect) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "effect", effect));
    auto out = std::make_unique<TyndallEffect>();
    TYNDALL_ASSIGN(const TyndallDeviceInfo callbacks, c::read(where, info, TyndallDeviceInfo{}));
    out->callbacks = std::make_shared<const TyndallDeviceInfo>(callbacks);
    TYNDALL_ASSIGN(const TyndallEffectDesc c_desc, c::read(where, desc, c::to_c(EffectDesc{})));
    out->callbacks_of_tables = c_desc.tables_of != nullptr ? c_desc.tables_of->callbacks_of_tables : out->callbacks;
    TYNDALL_ASSIGN(Effect made,
                   Effect::create(c::to_cpp(*out->callbacks), c::to_cpp(c_desc), c::params_or_defaults(params)));
    out->effect.emplace(std::move(made));
    *effect = out.release();
    return {};
  });
}

void tyndall_effect_destroy(TyndallEffect* effect) { const std::unique_ptr<TyndallEffect> owned(effect); }

TyndallStatus tyndall_effect_set_params(TyndallEffect* effect, const TyndallParams* params,
                                        const TyndallEffectDesc* desc) {
  return c::with(effect, __func__, [&](Effect& e, const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "params", params));
    if (desc == nullptr) return e.set_params(params->params);
    // Members that the program does not know stay as they are.
    TYNDALL_ASSIGN(TyndallEffectDesc changed, c::read(where, desc, c::to_c(e.desc())));
    changed.tables_of = nullptr;  // not read, and possibly destroyed since the effect was created
    return e.set_params(params->params, c::to_cpp(changed));
  });
}

TyndallStatus tyndall_effect_get_params(const TyndallEffect* effect, TyndallParams* params) {
  return c::with(effect, __func__, [&](const Effect& e, const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "params", params));
    params->params = e.params();
    return {};
  });
}

TyndallStatus tyndall_effect_get_table_params(const TyndallEffect* effect, TyndallParams* params) {
  return c::with(effect, __func__, [&](const Effect& e, const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "params", params));
    params->params = table_params(e);
    return {};
  });
}

TyndallStatus tyndall_effect_picture_color(const TyndallEffect* effect, const char** choice) {
  return c::with(effect, __func__, [&](const Effect& e, const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "choice", choice));
    *choice = picture_color(e) == ColorMode::spectral ? "spectral" : "rgb";
    return {};
  });
}

TyndallStatus tyndall_effect_get_desc(const TyndallEffect* effect, TyndallEffectDesc* desc) {
  return c::with(effect, __func__,
                 [&](const Effect& e, const char* where) { return c::write(where, c::to_c(e.desc()), desc); });
}

TyndallStatus tyndall_effect_set_shadow_colors(TyndallEffect* effect, VkBool32 shadow_colors) {
  return c::with(effect, __func__,
                 [&](Effect& e, const char*) { return e.set_shadow_colors(shadow_colors != VK_FALSE); });
}

TyndallStatus tyndall_effect_set_limits(TyndallEffect* effect, VkExtent2D max_extent, uint32_t max_cascades,
                                        uint32_t max_shadow_resolution) {
  return c::with(effect, __func__,
                 [&](Effect& e, const char*) { return e.set_limits(max_extent, max_cascades, max_shadow_resolution); });
}

TyndallStatus tyndall_effect_prepare_pipelines(TyndallEffect* effect, uint32_t budget, TyndallProgress* progress) {
  return c::with(effect, __func__, [&](Effect& e, const char*) -> Result<void> {
    TYNDALL_ASSIGN(const Progress made, e.prepare_pipelines(budget));
    c::write_progress(made, progress);
    return {};
  });
}

TyndallStatus tyndall_effect_precompute_progress(const TyndallEffect* effect, TyndallProgress* progress) {
  return c::with(effect, __func__, [&](const Effect& e, const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "progress", progress));
    c::write_progress(e.precompute_progress(), progress);
    return {};
  });
}

TyndallStatus tyndall_effect_record_precompute(TyndallEffect* effect, VkCommandBuffer cmd, uint32_t budget,
                                               TyndallProgress* progress) {
  return c::with(effect, __func__, [&](Effect& e, const char*) -> Result<void> {
    TYNDALL_ASSIGN(const Progress recorded, e.record_precompute(cmd, budget));
    c::write_progress(recorded, progress);
    return {};
  });
}

TyndallStatus tyndall_effect_table_key(const TyndallEffect* effect, size_t* size, char* key) {
  return c::with(effect, __func__, [&](const Effect& e, const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "size", size));
    const std::string text = e.table_key();
    if (text.empty()) return Error{ErrorCode::out_of_memory, std::string(where) + ": out of host memory"};
    const std::size_t room = *size;
    *size = text.size() + 1;
    if (key != nullptr && room >= *size) std::copy_n(text.c_str(), *size, key);
    return {};
  });
}

TyndallStatus tyndall_effect_table_bytes(const TyndallEffect* effect, VkDeviceSize* bytes) {
  return c::with(effect, __func__, [&](const Effect& e, const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "bytes", bytes));
    *bytes = e.table_bytes();
    return {};
  });
}

TyndallStatus tyndall_effect_record_save_tables(TyndallEffect* effect, VkCommandBuffer cmd, VkBuffer buffer,
                                                VkDeviceSize offset) {
  return c::with(effect, __func__, [&](Effect& e, const char*) { return e.record_save_tables(cmd, buffer, offset); });
}

TyndallStatus tyndall_effect_record_load_tables(TyndallEffect* effect, VkCommandBuffer cmd, VkBuffer buffer,
                                                VkDeviceSize offset) {
  return c::with(effect, __func__, [&](Effect& e, const char*) { return e.record_load_tables(cmd, buffer, offset); });
}

namespace {

Result<void> record(Effect& e, const char* where, VkCommandBuffer cmd, const TyndallFrameInputs* inputs,
                    FramePart part) {
  static const TyndallFrameInputs kDefaults = c::to_c(FrameInputs{});
  TYNDALL_ASSIGN(TyndallFrameInputs read, c::read(where, inputs, kDefaults));
  // Inputs that are not read may be gone.
  if (part == FramePart::drop) read.cascade_count = 0;
  if (read.cascade_count > kMaxCascades) {
    return c::invalid(where, "TyndallFrameInputs::cascade_count is " + std::to_string(read.cascade_count) +
                                 "; expected at most " + std::to_string(kMaxCascades));
  }
  if (read.cascade_count > 0) {
    TYNDALL_TRY(c::check_pointer(where, "TyndallFrameInputs::cascades", read.cascades));
  }
  std::array<Cascade, kMaxCascades> cascades;
  return e.record(cmd, c::to_cpp(read, cascades), part);
}

}  // namespace

TyndallStatus tyndall_effect_record(TyndallEffect* effect, VkCommandBuffer cmd, const TyndallFrameInputs* inputs) {
  return c::with(effect, __func__,
                 [&](Effect& e, const char* where) { return record(e, where, cmd, inputs, FramePart::whole); });
}

TyndallStatus tyndall_effect_record_part(TyndallEffect* effect, VkCommandBuffer cmd, const TyndallFrameInputs* inputs,
                                         TyndallFramePart part) {
  return c::with(effect, __func__, [&](Effect& e, const char* where) {
    return record(e, where, cmd, inputs, static_cast<FramePart>(part));
  });
}

TyndallStatus tyndall_effect_light_tables(const TyndallEffect* effect, TyndallLightTables* tables) {
  return c::with(effect, __func__, [&](const Effect& e, const char* where) {
    return c::write(where, c::to_c(e.light_tables()), tables);
  });
}

TyndallStatus tyndall_effect_scattering_tables(const TyndallEffect* effect, TyndallScatteringTables* tables) {
  return c::with(effect, __func__, [&](const Effect& e, const char* where) {
    return c::write(where, c::to_c(e.scattering_tables()), tables);
  });
}

TyndallStatus tyndall_effect_memory(const TyndallEffect* effect, TyndallMemoryUsage* memory) {
  return c::with(effect, __func__,
                 [&](const Effect& e, const char* where) { return c::write(where, c::to_c(e.memory()), memory); });
}

TyndallStatus tyndall_effect_counters(const TyndallEffect* effect, uint64_t frame_index, uint32_t view,
                                      TyndallCounters* counters) {
  return c::with(effect, __func__, [&](const Effect& e, const char* where) {
    return c::write(where, c::to_c(e.counters(frame_index, view)), counters);
  });
}

TyndallStatus tyndall_effect_resources(TyndallEffect* effect, uint32_t* count, TyndallResourceMemory* resources) {
  return c::with(effect, __func__, [&](Effect& e, const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "count", count));
    return c::write_array(e.resources(), count, resources);
  });
}

TyndallStatus tyndall_effect_atmosphere_images(const TyndallEffect* effect, uint32_t view, uint32_t* count,
                                               VkDescriptorImageInfo* images) {
  return c::with(effect, __func__, [&](const Effect& e, const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "count", count));
    const AtmosphereImages all = atmosphere_images(e, view);
    if (images != nullptr) std::copy_n(all.list.begin(), std::min(all.count, *count), images);
    *count = all.count;
    return {};
  });
}

TyndallStatus tyndall_effect_timings(TyndallEffect* effect, uint64_t frame_index, uint32_t view, uint32_t* count,
                                     TyndallPassTiming* timings) {
  return c::with(effect, __func__, [&](Effect& e, const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "count", count));
    return c::write_array(e.timings(frame_index, view), count, timings);
  });
}

TyndallStatus tyndall_effect_precompute_timings(TyndallEffect* effect, uint32_t* count, TyndallPassTiming* timings) {
  return c::with(effect, __func__, [&](Effect& e, const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "count", count));
    return c::write_array(e.precompute_timings(), count, timings);
  });
}
