// A hall generated in code: a vaulted nave with columns and benches, pointed windows of stained glass along both sides,
// and a rose window in the south. Sunlight enters only through glass.
#pragma once

#include "scene/mesh/mesh_data.hpp"

namespace tyndall::scene {

// Returns the hall in metres. The ground is at y = 0, the nave extends along z, and the rose window is at its end
// towards +z. The outside is 13.6 m wide, 37.6 m long and 16 m high.
[[nodiscard]] MeshData make_hall();

}  // namespace tyndall::scene
