// Constants of angles.
#pragma once

#include <numbers>

namespace tyndall {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kRadPerDeg = kPi / 180.0;

}  // namespace tyndall
