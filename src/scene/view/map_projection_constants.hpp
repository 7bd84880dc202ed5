// The structures of shaders/scene/map_projections.h in C++, with the layout that std430 gives them.
#pragma once

#include <cstddef>

#include "scene/view/shader_types.hpp"

namespace tyndall::scene::shared {

#include "scene/map_projections.h"

static_assert(sizeof(ProjectionLink) == 48 && offsetof(MapProjections, world_x) == 288 &&
              sizeof(MapProjections) == 336);

}  // namespace tyndall::scene::shared
