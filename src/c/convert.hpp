// Converts between the structures of C and C++.
#pragma once

#include <array>

#include "tyndall/atmosphere.hpp"
#include "tyndall/effect.hpp"
#include "tyndall/sky_probe.hpp"
#include "tyndall/tyndall.h"

namespace tyndall::c {

// `c` must outlive the result, whose callbacks call those of `c`.
[[nodiscard]] DeviceInfo to_cpp(const TyndallDeviceInfo& c);
[[nodiscard]] TyndallDeviceInfo to_c(const DeviceInfo& info);

[[nodiscard]] EffectDesc to_cpp(const TyndallEffectDesc& c);
[[nodiscard]] TyndallEffectDesc to_c(const EffectDesc& desc);

// `cascades` must outlive the result. Precondition: cascade_count <= kMaxCascades.
[[nodiscard]] FrameInputs to_cpp(const TyndallFrameInputs& c, std::array<Cascade, kMaxCascades>& cascades);
[[nodiscard]] TyndallFrameInputs to_c(const FrameInputs& inputs);  // without its cascades

[[nodiscard]] AtmosphereInputs to_cpp(const TyndallAtmosphereInputs& c);
[[nodiscard]] TyndallAtmosphereInputs to_c(const AtmosphereInputs& inputs);
[[nodiscard]] SkyProbeInputs to_cpp(const TyndallSkyProbeInputs& c);
[[nodiscard]] TyndallSkyProbeInputs to_c(const SkyProbeInputs& inputs);
[[nodiscard]] SkyProbeDesc to_cpp(const TyndallSkyProbeDesc& c);
[[nodiscard]] TyndallSkyProbeDesc to_c(const SkyProbeDesc& desc);
[[nodiscard]] TyndallSkyCube to_c(const SkyCube& cube);
[[nodiscard]] TyndallSkyCoefficients to_c(const SkyCoefficients& coefficients);

[[nodiscard]] TyndallMemoryUsage to_c(const MemoryUsage& memory);
[[nodiscard]] TyndallCounters to_c(const Counters& counters);
[[nodiscard]] TyndallLightTables to_c(const LightTables& tables);
[[nodiscard]] TyndallScatteringTables to_c(const ScatteringTables& tables);
[[nodiscard]] TyndallProgress to_c(const Progress& progress);
[[nodiscard]] TyndallResourceMemory to_c(const ResourceMemory& resource);
[[nodiscard]] TyndallPassTiming to_c(const PassTiming& timing);

}  // namespace tyndall::c
