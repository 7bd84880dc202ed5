#pragma once

#include <cstdint>

namespace tyndall::gpu {

// How many frames may be recorded or executing at a time in our own programs.
constexpr std::uint32_t kFramesInFlight = 2;

}  // namespace tyndall::gpu
