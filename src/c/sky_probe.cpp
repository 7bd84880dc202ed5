// The functions of the sky probe in C.
#include <memory>

#include "c/convert.hpp"
#include "c/error.hpp"
#include "c/handles.hpp"
#include "c/structures.hpp"
#include "gpu/try.hpp"

using namespace tyndall;

namespace {

Result<void> query(const char* where, const TyndallDeviceInfo* info, const SkyProbeDesc& desc,
                   TyndallMemoryUsage* memory) {
  TYNDALL_ASSIGN(const TyndallDeviceInfo callbacks, c::read(where, info, TyndallDeviceInfo{}));
  TYNDALL_ASSIGN(const MemoryUsage usage, SkyProbe::query_memory(c::to_cpp(callbacks), desc));
  return c::write(where, c::to_c(usage), memory);
}

Result<void> create(const char* where, TyndallEffect* effect, const SkyProbeDesc& desc, TyndallSkyProbe** probe) {
  TYNDALL_TRY(c::check_pointer(where, "effect", effect));
  TYNDALL_TRY(c::check_pointer(where, "probe", probe));
  auto out = std::make_unique<TyndallSkyProbe>();
  TYNDALL_ASSIGN(SkyProbe made, SkyProbe::create(*effect->effect, desc));
  out->probe.emplace(std::move(made));
  *probe = out.release();
  return {};
}

}  // namespace

TyndallStatus tyndall_sky_probe_inputs_defaults(TyndallSkyProbeInputs* inputs, size_t struct_size) {
  return c::call(__func__, [&](const char* where) {
    return c::write_defaults(where, c::to_c(SkyProbeInputs{}), inputs, struct_size);
  });
}

TyndallStatus tyndall_sky_probe_desc_defaults(TyndallSkyProbeDesc* desc, size_t struct_size) {
  return c::call(__func__, [&](const char* where) {
    return c::write_defaults(where, c::to_c(SkyProbeDesc{}), desc, struct_size);
  });
}

TyndallStatus tyndall_sky_probe_query_memory_with(const TyndallDeviceInfo* info, const TyndallSkyProbeDesc* desc,
                                                  TyndallMemoryUsage* memory) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_ASSIGN(const TyndallSkyProbeDesc read, c::read(where, desc, c::to_c(SkyProbeDesc{})));
    return query(where, info, c::to_cpp(read), memory);
  });
}

TyndallStatus tyndall_sky_probe_query_memory(const TyndallDeviceInfo* info, uint32_t frames_in_flight,
                                             TyndallMemoryUsage* memory) {
  return c::call(__func__, [&](const char* where) { return query(where, info, {frames_in_flight, 0}, memory); });
}

TyndallStatus tyndall_sky_probe_create_with(TyndallEffect* effect, const TyndallSkyProbeDesc* desc,
                                            TyndallSkyProbe** probe) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_ASSIGN(const TyndallSkyProbeDesc read, c::read(where, desc, c::to_c(SkyProbeDesc{})));
    return create(where, effect, c::to_cpp(read), probe);
  });
}

TyndallStatus tyndall_sky_probe_create(TyndallEffect* effect, uint32_t frames_in_flight, TyndallSkyProbe** probe) {
  return c::call(__func__, [&](const char* where) { return create(where, effect, {frames_in_flight, 0}, probe); });
}

void tyndall_sky_probe_destroy(TyndallSkyProbe* probe) { const std::unique_ptr<TyndallSkyProbe> owned(probe); }

TyndallStatus tyndall_sky_probe_record(TyndallSkyProbe* probe, VkCommandBuffer cmd, const TyndallSkyProbeInputs* inputs,
                                       uint32_t budget, TyndallProgress* progress) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "probe", probe));
    TYNDALL_ASSIGN(const TyndallSkyProbeInputs read, c::read(where, inputs, c::to_c(SkyProbeInputs{})));
    TYNDALL_ASSIGN(const Progress recorded, probe->probe->record(cmd, c::to_cpp(read), budget));
    if (progress != nullptr) *progress = c::to_c(recorded);
    return {};
  });
}

TyndallStatus tyndall_sky_probe_coefficients(const TyndallSkyProbe* probe, TyndallSkyCoefficients* coefficients) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "probe", probe));
    return c::write(where, c::to_c(probe->probe->coefficients()), coefficients);
  });
}

TyndallStatus tyndall_sky_probe_cube(const TyndallSkyProbe* probe, TyndallSkyCube* cube) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "probe", probe));
    return c::write(where, c::to_c(probe->probe->cube()), cube);
  });
}

TyndallStatus tyndall_sky_probe_memory(const TyndallSkyProbe* probe, TyndallMemoryUsage* memory) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "probe", probe));
    return c::write(where, c::to_c(probe->probe->memory()), memory);
  });
}
