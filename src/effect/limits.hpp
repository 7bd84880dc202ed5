// Checks before objects are created: of the ranges of descriptions, and of the device's limits.
#pragma once

#include "gpu/device.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

// Returns an error for the first field that is missing or out of range.
[[nodiscard]] Result<void> check_desc(const DeviceInfo& info, const EffectDesc& desc);
// Returns an error if a field differs that cannot change after the effect has been created.
[[nodiscard]] Result<void> check_same_desc(const EffectDesc& created, const EffectDesc& wanted);
// Returns an error if the device's limits do not suffice for the shaders of the effect and their dispatches.
[[nodiscard]] Result<void> check_device(const gpu::Device& device);
// Returns an error if these settings need a larger buffer or image than the device allows.
[[nodiscard]] Result<void> check_limits(const gpu::Device& device, const EffectDesc& desc, const Params& params);

}  // namespace tyndall
