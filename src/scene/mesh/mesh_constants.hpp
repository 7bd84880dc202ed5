// The structures of shaders/scene/mesh.h in C++, with the layout that std430 gives them.
#pragma once

#include <cstddef>

#include "scene/view/shader_types.hpp"

namespace tyndall::scene::shared {

#include "scene/mesh.h"

static_assert(offsetof(MeshConstants, shadow_from_local) == 64 && offsetof(MeshConstants, sun_irradiance) % 16 == 0);
static_assert(sizeof(MeshConstants) % 16 == 0 && sizeof(MeshInstance) == 112);

}  // namespace tyndall::scene::shared
