// Where meshes are placed: the tree of nodes of the scene.
#include "scene/mesh/gltf_reader.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace tyndall::scene {
namespace {

constexpr int kMaxNodeDepth = 256;  // of a tree of nodes
constexpr std::uint64_t kMaxNodeVisits = 1U << 20U;

}  // namespace

glm::dmat4 GltfReader::transform(const tinygltf::Node& node, std::size_t index) {
  glm::dmat4 out(1.0);
  if (node.matrix.size() == 16) {
    for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
  } else {
    const auto vector = [](const std::vector<double>& v, double rest) {
      return v.size() == 3 ? glm::dvec3(v[0], v[1], v[2]) : glm::dvec3(rest);
    };
    const glm::dvec3 scale = vector(node.scale, 1.0);
    glm::dquat turn(1.0, 0.0, 0.0, 0.0);
    if (node.rotation.size() == 4) turn = glm::dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(turn);
    if (!(length > 0.0)) fail("has " + at("nodes", index) + " with a rotation of no length", "allowed is a unit quaternion");
    const glm::dmat3 rotation = glm::mat3_cast(turn / length);
    for (int c = 0; c < 3; ++c) out[c] = glm::dvec4(rotation[c] * scale[c], 0.0);
    out[3] = glm::dvec4(vector(node.translation, 0.0), 1.0);
  }
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(out[c][r])) fail("has " + at("nodes", index) + " with a transform that is not finite", "allowed are finite numbers");
    }
  }
  return out;
}

void GltfReader::place(std::vector<std::vector<glm::dmat4>>& placed) {
  if (model_.scenes.empty()) {
    // Without a scene: every node that is no other's child.
    std::vector<bool> child(model_.nodes.size(), false);
    for (const tinygltf::Node& node : model_.nodes) {
      for (const int c : node.children) {
        if (c >= 0 && static_cast<std::size_t>(c) < child.size()) child[static_cast<std::size_t>(c)] = true;
      }
    }
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) {
      if (!child[i]) visit(static_cast<int>(i), glm::dmat4(1.0), 0, placed);
    }
    return;
  }
  const int index = model_.defaultScene < 0 ? 0 : model_.defaultScene;
  if (static_cast<std::size_t>(index) >= model_.scenes.size()) fail("asks for a scene that is not there", range(model_.scenes.size()));
  for (const int node : model_.scenes[static_cast<std::size_t>(index)].nodes) visit(node, glm::dmat4(1.0), 0, placed);
}

void GltfReader::visit(int index, const glm::dmat4& parent, int depth, std::vector<std::vector<glm::dmat4>>& placed) {
  if (index < 0 || static_cast<std::size_t>(index) >= model_.nodes.size()) fail("has a node that is not there", range(model_.nodes.size()));
  if (depth > kMaxNodeDepth || ++visits_ > kMaxNodeVisits) {
    fail("has nodes that are nested too deeply or in a circle", "allowed is a tree of up to " + std::to_string(kMaxNodeDepth) + " levels");
  }
  const auto i = static_cast<std::size_t>(index);
  const tinygltf::Node& node = model_.nodes[i];
  const glm::dmat4 here = parent * transform(node, i);
  if (node.mesh >= 0) {
    if (static_cast<std::size_t>(node.mesh) >= placed.size()) fail("has " + at("nodes", i) + " with a mesh that is not there", range(placed.size()));
    if (++instances_ > kMaxMeshInstances) fail("places too many meshes", "allowed are up to " + std::to_string(kMaxMeshInstances));
    placed[static_cast<std::size_t>(node.mesh)].push_back(here);
  }
  for (const int child : node.children) visit(child, here, depth + 1, placed);
}

}  // namespace tyndall::scene
