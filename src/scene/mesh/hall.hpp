// The inside of a hall, made in code: a vaulted nave with columns and benches, pointed windows of stained glass along
// both sides and a rose window in the south. What is lit inside is lit through glass.
#pragma once

#include "scene/mesh/mesh_data.hpp"

namespace tyndall::scene {

// Metres; the ground is at y = 0, the nave runs along z, the rose window is at its end towards +z. Outside it is 13.6 m
// wide, 37.6 m long and 16 m high.
[[nodiscard]] MeshData make_hall();

}  // namespace tyndall::scene
