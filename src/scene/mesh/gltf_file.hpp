// Loads meshes from glTF 2.0 files (.gltf with the files it refers to, or .glb): triangles with base colours.
// docs/meshes.md lists what is supported. The contents of files are not trusted.
#pragma once

#include <string>

#include "scene/mesh/mesh_data.hpp"
#include "tyndall/result.hpp"

namespace tyndall::scene {

// Returns the meshes of a file in its coordinates: right-handed, y up, metres. Error messages are one line with the
// file, the error and what was expected.
[[nodiscard]] Result<MeshData> load_gltf(const std::string& path);

}  // namespace tyndall::scene
