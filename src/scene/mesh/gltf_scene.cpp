// Places meshes according to the node tree of the scene and the joints of skins.
#include <algorithm>
#include <cmath>

#include "scene/mesh/gltf_reader.hpp"

namespace tyndall::scene {
namespace {

constexpr int kMaxNodeDepth = 256;
constexpr std::uint64_t kMaxNodeVisits = 1U << 20U;

[[noreturn]] void refuse_tree() {
  fail("has nodes that are nested too deeply or in a circle",
       "expected a tree of up to " + std::to_string(kMaxNodeDepth) + " levels");
}

}  // namespace

void GltfReader::note(std::string text) {
  if (std::find(out_.notes.begin(), out_.notes.end(), text) == out_.notes.end()) out_.notes.push_back(std::move(text));
}

void GltfReader::note_each(const char* kind, const std::string& text) {
  ++counted_.try_emplace(kind, text, 0).first->second.second;
}

void GltfReader::read() {
  out_.notes = document_.notes;
  data_.read_buffers();
  read_materials();
  parents_.assign(document_.nodes.size(), -1);
  for (std::size_t i = 0; i < document_.nodes.size(); ++i) {
    for (const int child : document_.nodes[i].children) parents_[static_cast<std::size_t>(child)] = static_cast<int>(i);
  }
  // The instances of the scene are collected first, so that meshes without instances are not read.
  for (const int root : document_.roots) visit(root, glm::dmat4(1.0), 0);
  for (const auto& [shape, placed] : placed_) read_shape(shape, placed);
  for (const auto& [kind, counted] : counted_) {
    const auto& [first, count] = counted;
    note(first + (count > 1 ? " (and " + std::to_string(count - 1) + " more of this kind)" : ""));
  }
  if (out_.indices.empty()) fail("has no triangles in its scene", "expected at least one triangle");
}

void GltfReader::visit(int index, const glm::dmat4& parent, int depth) {
  if (depth > kMaxNodeDepth || ++visits_ > kMaxNodeVisits) refuse_tree();
  const GltfNode& node = document_.nodes[static_cast<std::size_t>(index)];
  const glm::dmat4 here = parent * node.parent_from_node;
  if (node.mesh >= 0) {
    if (++instances_ > kMaxMeshInstances)
      fail("places too many meshes", "expected up to " + std::to_string(kMaxMeshInstances));
    const std::vector<double>& weights =
        node.weights ? *node.weights : document_.meshes[static_cast<std::size_t>(node.mesh)].weights;
    // The node of a mesh with a skin does not affect its position, only the joints do (glTF 2.0, section 3.7.3.3).
    placed_[Shape(node.mesh, node.skin, weights)].push_back(node.skin < 0 ? here : glm::dmat4(1.0));
  }
  for (const int child : node.children) visit(child, here, depth + 1);
}

glm::dmat4 GltfReader::scene_from_node(int index) const {
  glm::dmat4 out(1.0);
  for (int depth = 0; index >= 0; ++depth) {
    if (depth > kMaxNodeDepth) refuse_tree();
    out = document_.nodes[static_cast<std::size_t>(index)].parent_from_node * out;
    index = parents_[static_cast<std::size_t>(index)];
  }
  return out;
}

std::vector<glm::dmat4> GltfReader::joint_matrices(std::size_t skin) {
  const GltfSkin& in = document_.skins[skin];
  note("skins are drawn in the pose that the nodes have in the file, without animation");
  GltfValues inverse;
  if (in.inverse_bind >= 0)
    inverse = data_.values(static_cast<std::size_t>(in.inverse_bind), at("skins", skin) + ".inverseBindMatrices");
  std::vector<glm::dmat4> out;
  for (std::size_t i = 0; i < in.joints.size(); ++i) {
    glm::dmat4 joint_from_mesh(1.0);
    for (int k = 0; k < 16 && !inverse.empty(); ++k) joint_from_mesh[k / 4][k % 4] = inverse.real(i, k);
    out.push_back(scene_from_node(in.joints[i]) * joint_from_mesh);
  }
  return out;
}

}  // namespace tyndall::scene
