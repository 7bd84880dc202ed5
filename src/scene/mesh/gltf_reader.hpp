// Converts a glTF document to MeshData. Scenes and skins are converted in gltf_scene.cpp, pictures in gltf_images.cpp
// and triangles in gltf_geometry.cpp. Only these files and gltf_file.cpp include this header.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "scene/mesh/gltf_data.hpp"
#include "scene/mesh/gltf_decoders.hpp"
#include "scene/mesh/gltf_document.hpp"
#include "scene/mesh/mesh_data.hpp"

namespace tyndall::scene {

// The vertices of a primitive, with morph targets and the skin applied.
struct GltfVertices {
  struct Target {
    double weight = 0.0;
    GltfValues position, normal, uv, color;
  };
  struct Influence {
    GltfValues joints, weights;
  };
  GltfValues position, normal, uv, color;
  std::vector<Target> targets;        // morph targets whose weight is not 0
  std::vector<Influence> influences;  // weights of joints; empty without a skin
  const std::vector<glm::dmat4>* joints = nullptr;
  GltfTextureUse texture;
  std::string where;                // path of the primitive, for messages
  mutable bool clamped = false;     // a colour was outside 0 to 1
  mutable bool unweighted = false;  // a vertex has no joint

  [[nodiscard]] MeshVertex at(std::size_t i) const;
  // Returns whether the joints mirror the mesh, which turns its triangles over.
  [[nodiscard]] bool mirrored() const;

 private:
  [[nodiscard]] glm::dvec4 morphed(const GltfValues& base, GltfValues Target::*target, std::size_t i) const;
  [[nodiscard]] glm::dmat4 skinned(std::size_t i) const;
};

class GltfReader {
 public:
  GltfReader(const GltfDocument& document, GltfData& data, MeshData& out)
      : document_(document), data_(data), out_(out) {}

  // Reads the document. Throws GltfFailure.
  void read();

 private:
  // A mesh, its skin or -1, and the weights of its morph targets. Nodes with equal shapes are instances of one mesh.
  using Shape = std::tuple<int, int, std::vector<double>>;

  void note(std::string text);  // adds the text to the notes, unless it is there already
  // Notes the first text of a kind, and the number of texts that follow.
  void note_each(const char* kind, const std::string& text);

  void read_materials();
  int read_image(std::size_t index, bool opaque);
  // Returns the material of a primitive, without its texture if the primitive has no texture coordinates.
  std::uint32_t material_of(const GltfPrimitive& primitive, bool has_coordinates, const std::string& where);

  void visit(int index, const glm::dmat4& parent, int depth);
  [[nodiscard]] glm::dmat4 scene_from_node(int index) const;
  std::vector<glm::dmat4> joint_matrices(std::size_t skin);

  void read_shape(const Shape& shape, const std::vector<glm::dmat4>& placed);
  void read_primitive(const GltfPrimitive& primitive, const std::string& where, const Shape& shape,
                      const std::vector<glm::dmat4>& joints);
  GltfValues attribute(const GltfAttributes& attributes, const std::string& name, const std::string& where,
                       const DracoMesh* draco, std::size_t count, int min_components, int max_components);
  GltfVertices vertices(const GltfPrimitive& primitive, const std::string& where, const DracoMesh* draco,
                        const Shape& shape, const std::vector<glm::dmat4>& joints);
  std::vector<std::uint32_t> triangles(const GltfPrimitive& primitive, const std::string& where, std::size_t count);
  void emit(const GltfVertices& vertices, const std::vector<std::uint32_t>& corners, std::uint32_t material);

  const GltfDocument& document_;
  GltfData& data_;
  MeshData& out_;
  std::map<Shape, std::vector<glm::dmat4>> placed_;
  std::vector<int> parents_;  // the parent of each node; -1 for roots
  std::map<std::string, std::pair<std::string, std::size_t>>
      counted_;                                          // by kind: the first text and the number of texts
  std::map<std::pair<std::size_t, bool>, int> decoded_;  // the texture of each decoded image, and whether it is opaque
  std::map<int, std::uint32_t> untextured_;              // the copy without a texture of a material
  std::uint64_t texture_bytes_ = 0, visits_ = 0, instances_ = 0;
};

}  // namespace tyndall::scene
