// Meshes, nodes, skins and scenes of a glTF document.
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "scene/mesh/gltf_decoders.hpp"
#include "scene/mesh/gltf_json.hpp"

namespace tyndall::scene {
namespace {

GltfAttributes attributes(const GltfJson& json) {
  GltfAttributes out;
  for (auto& [semantic, accessor] : json.named_indices("accessors")) out[semantic] = accessor;
  return out;
}

GltfPrimitive primitive(const GltfJson& json) {
  GltfPrimitive out;
  out.attributes = attributes(json.object("attributes"));
  out.indices = json.index("indices", "accessors");
  out.material = json.index("material", "materials");
  out.mode = static_cast<int>(json.integer("mode", 0, 6, 4));
  for (const GltfJson& target : json.objects("targets")) out.targets.push_back(attributes(target));
  if (const auto draco = json.extension("KHR_draco_mesh_compression"); kHasDraco && draco) {
    if (out.mode != 4 && out.mode != 5) json.refuse("mode", "expected 4 and 5 with KHR_draco_mesh_compression");
    GltfDraco compressed;
    compressed.view = static_cast<std::size_t>(draco->index("bufferView", "bufferViews", true));
    const GltfJson numbers = draco->object("attributes");
    for (const auto& [semantic, accessor] : out.attributes) {
      if (!numbers.has(semantic.c_str())) continue;
      compressed.attributes[semantic] = static_cast<std::uint32_t>(numbers.integer(semantic.c_str(), 0, 65535));
    }
    out.draco = std::move(compressed);
  }
  return out;
}

glm::dmat4 local_transform(const GltfJson& json) {
  glm::dmat4 out(1.0);
  if (json.numbers("matrix", std::span<double>(&out[0][0], 16))) {
    for (const char* const other : {"translation", "rotation", "scale"}) {
      if (json.has(other)) fail(json.path() + " has both a matrix and a " + other, "expected one of them");
    }
    if (std::abs(out[0][3]) > 1e-6 || std::abs(out[1][3]) > 1e-6 || std::abs(out[2][3]) > 1e-6 ||
        std::abs(out[3][3] - 1.0) > 1e-6) {
      json.refuse("matrix", "expected a matrix whose fourth row is 0, 0, 0, 1");
    }
    return out;
  }
  glm::dvec3 translation(0.0), scale(1.0);
  glm::dvec4 rotation(0.0, 0.0, 0.0, 1.0);
  json.numbers("translation", std::span<double>(&translation.x, 3));
  json.numbers("scale", std::span<double>(&scale.x, 3));
  json.bounded("rotation", -1.0, 1.0, std::span<double>(&rotation.x, 4));
  const double length = glm::length(rotation);
  if (!(length > 1e-3)) fail(json.path("rotation") + " has no length", "expected a unit quaternion");
  rotation /= length;
  const glm::dmat3 turned = glm::mat3_cast(glm::dquat(rotation.w, rotation.x, rotation.y, rotation.z));
  for (int c = 0; c < 3; ++c) out[c] = glm::dvec4(turned[c] * scale[c], 0.0);
  out[3] = glm::dvec4(translation, 1.0);
  return out;
}

GltfMesh mesh(const GltfJson& json) {
  GltfMesh out;
  for (const GltfJson& part : json.objects("primitives")) out.primitives.push_back(primitive(part));
  if (out.primitives.empty()) json.refuse("primitives", "expected an array of at least one primitive");
  const std::size_t targets = out.primitives[0].targets.size();
  for (const GltfPrimitive& part : out.primitives) {
    if (part.targets.size() != targets)
      fail(json.path() + " has primitives with unequal numbers of morph targets", "expected one number for all");
  }
  out.weights = json.numbers("weights");
  if (json.has("weights") && out.weights.size() != targets) {
    json.refuse("weights", "expected " + std::to_string(targets) + " numbers, one for each morph target");
  }
  out.weights.resize(targets, 0.0);
  return out;
}

GltfNode node(const GltfJson& json, const GltfDocument& document) {
  GltfNode out;
  out.parent_from_node = local_transform(json);
  out.mesh = json.index("mesh", "meshes");
  out.skin = json.index("skin", "skins");
  out.children = json.indices("children", "nodes");
  if (json.has("weights")) {
    out.weights = json.numbers("weights");
    const std::size_t targets = out.mesh < 0 ? 0 : document.meshes[static_cast<std::size_t>(out.mesh)].weights.size();
    if (out.weights->size() != targets) {
      json.refuse("weights", "expected " + std::to_string(targets) + " numbers, one for each morph target of its mesh");
    }
  }
  return out;
}

GltfSkin skin(const GltfJson& json, const GltfDocument& document) {
  GltfSkin out;
  out.joints = json.indices("joints", "nodes");
  if (out.joints.empty()) json.refuse("joints", "expected an array of at least one node");
  out.inverse_bind = json.index("inverseBindMatrices", "accessors");
  if (out.inverse_bind >= 0) {
    const GltfAccessor& accessor = document.accessors[static_cast<std::size_t>(out.inverse_bind)];
    if (accessor.components != 16 || accessor.component != GltfComponent::float32 ||
        accessor.count < out.joints.size()) {
      json.refuse("inverseBindMatrices",
                  "expected an accessor of at least " + std::to_string(out.joints.size()) + " MAT4 of floats");
    }
  }
  return out;
}

}  // namespace

void parse_nodes(const GltfJson& root, GltfDocument& out, std::set<std::string>& undrawn) {
  for (const GltfJson& json : root.objects("meshes")) out.meshes.push_back(mesh(json));
  for (const GltfJson& json : root.objects("nodes")) out.nodes.push_back(node(json, out));
  for (const GltfJson& json : root.objects("skins")) out.skins.push_back(skin(json, out));
  const std::vector<GltfJson> scenes = root.objects("scenes");
  const int index = root.index("scene", "scenes");
  if (!scenes.empty()) {
    out.roots = scenes[index < 0 ? 0 : static_cast<std::size_t>(index)].indices("nodes", "nodes");
    if (index < 0 && scenes.size() > 1) undrawn.insert("scenes after the first (the file names no default scene)");
  } else {
    // Without a scene, the roots are all nodes that are not children of others.
    std::vector<bool> child(out.nodes.size(), false);
    for (const GltfNode& one : out.nodes) {
      for (const int c : one.children) child[static_cast<std::size_t>(c)] = true;
    }
    for (std::size_t i = 0; i < out.nodes.size(); ++i) {
      if (!child[i]) out.roots.push_back(static_cast<int>(i));
    }
  }
  if (root.has("animations")) undrawn.insert("animations (the nodes are drawn at their initial positions)");
}

}  // namespace tyndall::scene
