// The ids of shaders/scene/constant_ids.h in C++.
#pragma once

#include "scene/view/shader_types.hpp"

namespace tyndall::scene::shared {

#include "scene/constant_ids.h"

}  // namespace tyndall::scene::shared
