// The contents of a glTF file as far as the demo scene uses them. parse_gltf() checks them against the schema of glTF
// 2.0: every index is in range, every number is finite and in its range.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/mesh/mesh_data.hpp"

namespace tyndall::scene {

// The exception of all functions that read glTF: an error in the file, and what was expected. load_gltf() turns it into
// an Error.
struct GltfFailure {
  std::string what, allowed;
};

[[noreturn]] inline void fail(std::string what, std::string allowed) {
  throw GltfFailure{std::move(what), std::move(allowed)};
}

// Returns the path of an element, such as "accessors[3]".
inline std::string at(std::string list, std::size_t index) {
  return std::move(list) + "[" + std::to_string(index) + "]";
}

enum class GltfComponent : int {
  int8 = 5120,
  uint8 = 5121,
  int16 = 5122,
  uint16 = 5123,
  uint32 = 5125,
  float32 = 5126,
};
[[nodiscard]] std::size_t bytes_of(GltfComponent component);

struct GltfBuffer {
  std::optional<std::string> uri;  // if missing, the buffer is the binary chunk of a .glb
  std::uint64_t length = 0;
  bool fallback = false;  // contains data only for readers without EXT_meshopt_compression
};

// EXT_meshopt_compression of a view: the range of a buffer with the compressed bytes of the view.
struct GltfMeshopt {
  enum class Mode { attributes, triangles, indices };
  enum class Filter { none, octahedral, quaternion, exponential };
  std::size_t buffer = 0;
  std::uint64_t offset = 0, length = 0;
  std::size_t stride = 0, count = 0;
  Mode mode = Mode::attributes;
  Filter filter = Filter::none;
};

struct GltfView {
  std::size_t buffer = 0;
  std::uint64_t offset = 0, length = 0;
  std::size_t stride = 0;  // 0: tightly packed elements
  std::optional<GltfMeshopt> meshopt;
};

// Elements whose values replace those of an accessor.
struct GltfSparse {
  std::size_t count = 0, index_view = 0, value_view = 0;
  std::uint64_t index_offset = 0, value_offset = 0;
  GltfComponent index_component = GltfComponent::uint16;
};

struct GltfAccessor {
  int view = -1;  // -1: zeros
  std::uint64_t offset = 0;
  std::size_t count = 0;
  GltfComponent component = GltfComponent::float32;
  int components = 1;
  bool normalized = false;
  std::optional<GltfSparse> sparse;
};

struct GltfImage {
  std::optional<std::string> uri;
  int view = -1;  // the view with the image file, if it has no uri
};

struct GltfTexture {
  int image = -1;  // -1: the texture has an image only in an unsupported extension
  MeshSampler sampler;
};

// The base colour's texture, with KHR_texture_transform.
struct GltfTextureUse {
  int texture = -1;
  int set = 0;  // the n of TEXCOORD_n
  glm::dvec2 offset = glm::dvec2(0.0), scale = glm::dvec2(1.0);
  double rotation_rad = 0.0;
};

struct GltfMaterial {
  MeshMaterial drawn;  // without the texture, which `texture` describes
  GltfTextureUse texture;
};

using GltfAttributes = std::map<std::string, int>;  // accessors by semantic

// KHR_draco_mesh_compression: the compressed view, and the attributes by their numbers in the decoder.
struct GltfDraco {
  std::size_t view = 0;
  std::map<std::string, std::uint32_t> attributes;
};

struct GltfPrimitive {
  GltfAttributes attributes;
  int indices = -1, material = -1, mode = 4;
  std::vector<GltfAttributes> targets;
  std::optional<GltfDraco> draco;
};

struct GltfMesh {
  std::vector<GltfPrimitive> primitives;
  std::vector<double> weights;  // one for each morph target; every primitive has the same number of them
};

struct GltfNode {
  glm::dmat4 parent_from_node = glm::dmat4(1.0);
  int mesh = -1, skin = -1;
  std::vector<int> children;
  std::optional<std::vector<double>> weights;  // replaces the weights of the mesh
};

struct GltfSkin {
  std::vector<int> joints;
  int inverse_bind = -1;  // accessor; -1: identities
};

struct GltfDocument {
  std::vector<GltfBuffer> buffers;
  std::vector<GltfView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfImage> images;
  std::vector<GltfTexture> textures;
  std::vector<GltfMaterial> materials;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  std::vector<GltfSkin> skins;
  std::vector<int> roots;          // root nodes of the default scene
  std::vector<std::string> notes;  // contents of the file that are not drawn, one line each
};

// Parses and checks the JSON of a file. Throws GltfFailure.
[[nodiscard]] GltfDocument parse_gltf(std::string_view json);

}  // namespace tyndall::scene
