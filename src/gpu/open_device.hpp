// Fills in a Device from the handles of a caller.
#pragma once

#include "gpu/device.hpp"
#include "tyndall/effect.hpp"

namespace tyndall::gpu {

// Copies the handles and callbacks of `info`, then calls init_device().
Result<void> open_device(Device& device, const DeviceInfo& info);

}  // namespace tyndall::gpu
