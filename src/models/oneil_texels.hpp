// How shaders/lib/oneil.glsl reads its table in C++, whatever precision it is compiled in.
#pragma once

#include <array>

namespace tyndall::models {

using OneilTexels = const std::array<float, 4>*;

}  // namespace tyndall::models
