#pragma once

#include <cstdint>

namespace tyndall::gpu {

// The number of frames that our own programs may be recording or executing at a time.
constexpr std::uint32_t kFramesInFlight = 2;

}  // namespace tyndall::gpu
