// Access to the table of shaders/lib/oneil.glsl from C++, in any precision.
#pragma once

#include <array>

namespace tyndall::models {

using OneilTexels = const std::array<float, 4>*;

}  // namespace tyndall::models
