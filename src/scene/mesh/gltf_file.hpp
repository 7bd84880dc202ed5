// Meshes from glTF 2.0 files (.gltf with what it refers to, .glb): triangles with base colours. What is supported and
// what is left out stands in docs/meshes.md. Nothing that a file holds is trusted.
#pragma once

#include <string>

#include "scene/mesh/mesh_data.hpp"
#include "tyndall/result.hpp"

namespace tyndall::scene {

// Coordinates as in the file: right-handed, y up, metres. Errors are one line: the file, what is wrong with it, what
// is allowed.
[[nodiscard]] Result<MeshData> load_gltf(const std::string& path);

}  // namespace tyndall::scene
