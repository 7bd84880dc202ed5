// What can be refused before anything is created: descriptions out of range, and settings that the device's limits do
// not allow.
#pragma once

#include "gpu/device.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

// The first field that is missing or out of range, as an error.
[[nodiscard]] Result<void> check_desc(const DeviceInfo& info, const EffectDesc& desc);
// An error where a field differs that is fixed when the effect is created.
[[nodiscard]] Result<void> check_same_desc(const EffectDesc& created, const EffectDesc& wanted);
// An error where the device's limits do not suffice for the shaders of the effect and their dispatches.
[[nodiscard]] Result<void> check_device(const gpu::Device& device);
// An error where a buffer or an image that these settings need is larger than the device allows.
[[nodiscard]] Result<void> check_limits(const gpu::Device& device, const EffectDesc& desc, const Params& params);

}  // namespace tyndall
