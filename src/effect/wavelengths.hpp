// The constants of shaders/shared/wavelengths.h in C++.
#pragma once

#include "effect/shared.hpp"

namespace tyndall::shared {

#include "shared/wavelengths.h"

}  // namespace tyndall::shared
