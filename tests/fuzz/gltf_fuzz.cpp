// glTF files, as text or .glb, with a buffer and a picture beside them.
#include "scene/mesh/gltf_file.hpp"

#include <cmath>

#include "fuzz.hpp"

namespace {

using namespace tyndall;

void check(const scene::MeshData& mesh) {
  for (const std::uint32_t index : mesh.indices) fuzz::require(index < mesh.vertices.size(), "indices name vertices");
  for (const scene::MeshPart& part : mesh.parts) {
    fuzz::require(std::uint64_t{part.first_index} + part.index_count <= mesh.indices.size(), "parts have indices");
    fuzz::require(part.material < mesh.materials.size(), "parts have a material");
  }
  for (const scene::Mesh& one : mesh.meshes) {
    fuzz::require(std::uint64_t{one.first_part} + one.part_count <= mesh.parts.size(), "meshes have parts");
    fuzz::require(std::uint64_t{one.first_instance} + one.instance_count <= mesh.instances.size(),
                  "meshes have instances");
  }
  for (const scene::MeshMaterial& material : mesh.materials) {
    fuzz::require(material.texture < static_cast<int>(mesh.textures.size()), "materials have textures");
  }
  for (const scene::MeshTexture& texture : mesh.textures) {
    fuzz::require(texture.rgba.size() == std::size_t{4} * texture.width * texture.height, "textures are complete");
  }
  for (const scene::MeshVertex& vertex : mesh.vertices) {
    fuzz::require(std::isfinite(vertex.position.x + vertex.position.y + vertex.position.z), "positions are finite");
    const float length = glm::length(vertex.normal);
    fuzz::require(std::abs(length - 1.0F) < 1e-3F, "normals have unit length");
  }
  fuzz::require(mesh.bounds.empty() || std::isfinite(mesh.bounds.max.x - mesh.bounds.min.x), "the bounds are finite");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  static const std::string beside = folder.write("a.bin", std::string(256, '\1'));
  const Result<scene::MeshData> mesh = scene::load_gltf(folder.write("fuzz.gltf", fuzz::text_of(data, size)));
  if (!mesh) {
    fuzz::require_one_line(mesh.error());
  } else {
    check(mesh.value());
  }
  return 0;
}
