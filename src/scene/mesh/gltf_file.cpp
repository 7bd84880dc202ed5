// Reading through tinygltf and stb_image, both kept to this file. tinygltf parses; what its model holds is checked
// here before it is used. Pictures are decoded here too: tinygltf passes on any range of a buffer that a file names.
#include "scene/mesh/gltf_file.hpp"

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_STB_IMAGE
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_MAX_DIMENSIONS 8192
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <memory>
#include <span>

#include "config/files.hpp"
#include "config/text.hpp"

namespace tyndall::scene {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 31U;
constexpr int kMaxJsonDepth = 96;   // tinygltf recurses
constexpr int kMaxNodeDepth = 256;  // of a tree of nodes
constexpr std::uint64_t kMaxNodeVisits = 1U << 20U;
constexpr double kLargestCoordinate_m = 1.0e7;

struct Failure {
  std::string what, allowed;
};

[[noreturn]] void fail(std::string what, std::string allowed) { throw Failure{std::move(what), std::move(allowed)}; }

std::string at(const char* list, std::size_t index) { return std::string(list) + "[" + std::to_string(index) + "]"; }

// Depth of the nesting of a JSON text, strings left out.
bool too_deep(std::string_view json) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxJsonDepth) return true;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return false;
}

// Files that a glTF file refers to. The last error is kept: tinygltf says less.
bool read_whole(std::vector<unsigned char>* out, std::string* error, const std::string& path, void*) {
  Result<std::string> text = config::read_file(path, kMaxFileBytes);
  if (!text.ok()) {
    *error = text.error().message;
    return false;
  }
  out->assign(text.value().begin(), text.value().end());
  return true;
}

bool exists(const std::string& path, void*) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

std::string unchanged(const std::string& path, void*) { return path; }

// Keeps the file's bytes of a picture; those of buffers are looked up when they are needed.
bool keep_bytes(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

class Reader {
 public:
  Reader(const tinygltf::Model& model, MeshData& out) : model_(model), out_(out) {}

  void read() {
    check_extensions();
    read_materials();
    // A mesh without instances costs nothing: those of the scene are collected first.
    std::vector<std::vector<glm::dmat4>> placed(model_.meshes.size());
    place(placed);
    for (std::size_t i = 0; i < placed.size(); ++i) {
      if (!placed[i].empty()) read_mesh(i, placed[i]);
    }
    if (out_.indices.empty()) fail("has no triangles in its scene", "allowed is a file with at least one triangle");
    if (skipped_lines_) out_.notes.emplace_back("lines and points of the meshes are left out");
    if (!model_.animations.empty() || !model_.skins.empty()) {
      out_.notes.emplace_back("the meshes are drawn at rest: animations and skins are left out");
    }
  }

 private:
  void check_extensions() const {
    for (const std::string& name : model_.extensionsRequired) {
      const bool known = name.rfind("KHR_materials_", 0) == 0 || name == "KHR_mesh_quantization" ||
                         name == "KHR_texture_transform" || name == "KHR_lights_punctual";
      if (!known) fail("requires the extension " + name, "allowed are KHR_materials_*, KHR_mesh_quantization and KHR_texture_transform");
    }
  }

  // --- materials ---

  void read_materials() {
    for (std::size_t i = 0; i < model_.materials.size(); ++i) out_.materials.push_back(material(i));
    out_.materials.emplace_back();  // of parts that name none
  }

  MeshMaterial material(std::size_t index) {
    const tinygltf::Material& in = model_.materials[index];
    MeshMaterial out;
    out.name = in.name;
    const std::vector<double>& factor = in.pbrMetallicRoughness.baseColorFactor;
    for (int c = 0; c < 4 && c < static_cast<int>(factor.size()); ++c) {
      out.color[c] = static_cast<float>(bounded(factor[static_cast<std::size_t>(c)], index, "baseColorFactor"));
    }
    out.roughness = static_cast<float>(bounded(in.pbrMetallicRoughness.roughnessFactor, index, "roughnessFactor"));
    out.alpha_cutoff = static_cast<float>(std::clamp(in.alphaCutoff, 0.0, 1.0));
    out.double_sided = in.doubleSided;
    if (in.alphaMode == "MASK") out.kind = SurfaceKind::mask;
    if (in.alphaMode == "BLEND") out.kind = SurfaceKind::blend;
    const auto extension = in.extensions.find("KHR_materials_transmission");
    if (extension != in.extensions.end() && extension->second.IsObject()) {
      const tinygltf::Value& value = extension->second.Get("transmissionFactor");
      if (value.IsNumber() && value.GetNumberAsDouble() > 0.0) {
        out.kind = SurfaceKind::glass;
        out.transmission = static_cast<float>(bounded(value.GetNumberAsDouble(), index, "transmissionFactor"));
      }
    }
    if (in.pbrMetallicRoughness.baseColorTexture.index >= 0) {
      out.texture = texture(static_cast<std::size_t>(in.pbrMetallicRoughness.baseColorTexture.index), index);
    }
    return out;
  }

  static double bounded(double value, std::size_t index, const char* name) {
    if (!(value >= 0.0 && value <= 1.0)) fail("has " + at("materials", index) + "." + name + " out of range", "allowed is 0 to 1");
    return value;
  }

  // The picture of a texture, decoded once.
  int texture(std::size_t index, std::size_t material) {
    if (index >= model_.textures.size()) fail("has " + at("materials", material) + " with a texture that is not there", range(model_.textures.size()));
    const int source = model_.textures[index].source;
    if (source < 0 || static_cast<std::size_t>(source) >= model_.images.size()) {
      fail("has " + at("textures", index) + " with an image that is not there", range(model_.images.size()));
    }
    const auto known = decoded_.find(source);
    if (known != decoded_.end()) return known->second;
    const tinygltf::Image& image = model_.images[static_cast<std::size_t>(source)];
    std::span<const unsigned char> bytes(image.image);
    if (image.bufferView >= 0) bytes = view_bytes(static_cast<std::size_t>(image.bufferView));
    const std::string name = at("images", static_cast<std::size_t>(source)) +
                             (image.uri.empty() ? "" : " '" + config::one_line(image.uri, 200) + "'");
    if (bytes.empty()) fail("has " + name + ", which cannot be read", "allowed is a PNG or JPEG picture beside it or in it");
    int width = 0, height = 0, channels = 0;
    const int size = static_cast<int>(std::min<std::size_t>(bytes.size(), std::numeric_limits<int>::max()));
    if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) {
      fail("has " + name + ", which is no picture", "allowed are PNG and JPEG of up to " + std::to_string(kMaxTextureSide) + " texels on a side");
    }
    if (width <= 0 || height <= 0 || width > static_cast<int>(kMaxTextureSide) || height > static_cast<int>(kMaxTextureSide)) {
      fail("has " + name + " of " + std::to_string(width) + "x" + std::to_string(height), "allowed are up to " + std::to_string(kMaxTextureSide) + " texels on a side");
    }
    texture_bytes_ += 4ULL * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    if (texture_bytes_ > kMaxTextureBytes) fail("has more texels than there is room for", "allowed are textures of up to 1 GiB together");
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
    if (pixels == nullptr) fail("has " + name + ", which is damaged", "allowed is a whole PNG or JPEG picture");
    MeshTexture out;
    out.width = static_cast<std::uint32_t>(width);
    out.height = static_cast<std::uint32_t>(height);
    out.rgba.assign(pixels.get(), pixels.get() + 4ULL * out.width * out.height);
    out_.textures.push_back(std::move(out));
    return decoded_[source] = static_cast<int>(out_.textures.size()) - 1;
  }

  // --- nodes ---

  static glm::dmat4 transform(const tinygltf::Node& node, std::size_t index) {
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

  void place(std::vector<std::vector<glm::dmat4>>& placed) {
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

  void visit(int index, const glm::dmat4& parent, int depth, std::vector<std::vector<glm::dmat4>>& placed) {
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

  // --- geometry ---

  // An accessor whose range has been checked.
  struct Values {
    const unsigned char* data = nullptr;
    std::size_t count = 0, stride = 0;
    int type = 0, components = 0;
    bool normalized = false;
    [[nodiscard]] double real(std::size_t i, int c) const {
      const unsigned char* p = data + i * stride;
      const auto c_ = static_cast<std::size_t>(c);
      switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE: return scaled(get<std::int8_t>(p, c_), 127.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return scaled(get<std::uint8_t>(p, c_), 255.0);
        case TINYGLTF_COMPONENT_TYPE_SHORT: return scaled(get<std::int16_t>(p, c_), 32767.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return scaled(get<std::uint16_t>(p, c_), 65535.0);
        case TINYGLTF_COMPONENT_TYPE_INT: return scaled(get<std::int32_t>(p, c_), 2147483647.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return scaled(get<std::uint32_t>(p, c_), 4294967295.0);
        case TINYGLTF_COMPONENT_TYPE_DOUBLE: return get<double>(p, c_);
        default: return static_cast<double>(get<float>(p, c_));
      }
    }
    [[nodiscard]] std::uint64_t whole(std::size_t i) const {
      const unsigned char* p = data + i * stride;
      if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return get<std::uint8_t>(p, 0);
      if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return get<std::uint16_t>(p, 0);
      return get<std::uint32_t>(p, 0);
    }

   private:
    template <typename T>
    static T get(const unsigned char* p, std::size_t c) {
      T value{};
      std::memcpy(&value, p + c * sizeof(T), sizeof(T));
      return value;
    }
    template <typename T>
    [[nodiscard]] double scaled(T value, double most) const {
      return normalized ? std::max(static_cast<double>(value) / most, -1.0) : static_cast<double>(value);
    }
  };

  std::span<const unsigned char> view_bytes(std::size_t index) const {
    if (index >= model_.bufferViews.size()) fail("has a bufferView that is not there", range(model_.bufferViews.size()));
    const tinygltf::BufferView& view = model_.bufferViews[index];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size()) {
      fail("has " + at("bufferViews", index) + " of a buffer that is not there", range(model_.buffers.size()));
    }
    const std::vector<unsigned char>& bytes = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) {
      fail("has " + at("bufferViews", index) + " beyond the end of its buffer", "allowed are up to " + std::to_string(bytes.size()) + " bytes");
    }
    return std::span(bytes).subspan(view.byteOffset, view.byteLength);
  }

  Values values(int index) const {
    if (index < 0 || static_cast<std::size_t>(index) >= model_.accessors.size()) fail("has an accessor that is not there", range(model_.accessors.size()));
    const auto i = static_cast<std::size_t>(index);
    const tinygltf::Accessor& accessor = model_.accessors[i];
    if (accessor.sparse.isSparse) fail("has " + at("accessors", i) + ", which is sparse", "allowed are accessors without sparse");
    if (accessor.bufferView < 0) fail("has " + at("accessors", i) + " without data", "allowed are accessors with a bufferView");
    const std::span<const unsigned char> bytes = view_bytes(static_cast<std::size_t>(accessor.bufferView));
    const int component = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (component <= 0 || components <= 0) fail("has " + at("accessors", i) + " of an unknown type", "allowed are the types of glTF 2.0");
    const auto element = static_cast<std::size_t>(component) * static_cast<std::size_t>(components);
    const std::size_t step = model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
    Values out;
    out.stride = step == 0 ? element : step;
    out.count = accessor.count;
    out.type = accessor.componentType;
    out.components = components;
    out.normalized = accessor.normalized;
    if (out.count == 0 || out.count > std::max(kMaxMeshVertices, kMaxMeshIndices)) {
      fail("has " + at("accessors", i) + " of " + std::to_string(out.count) + " elements", "allowed are 1 to " + std::to_string(kMaxMeshIndices));
    }
    if (out.stride < element || out.stride > 1024 || accessor.byteOffset > bytes.size() ||
        (out.count - 1) * out.stride + element > bytes.size() - accessor.byteOffset) {
      fail("has " + at("accessors", i) + " beyond the end of its bufferView", "allowed are up to " + std::to_string(bytes.size()) + " bytes");
    }
    out.data = bytes.data() + accessor.byteOffset;
    return out;
  }

  // The values of an attribute, or none.
  Values attribute(const tinygltf::Primitive& primitive, const std::string& name, std::size_t count, int least, int most) const {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return {};
    const Values out = values(found->second);
    if (out.components < least || out.components > most) fail("has an attribute " + name + " of " + std::to_string(out.components) + " components", "allowed are " + std::to_string(least) + " to " + std::to_string(most));
    if (count > 0 && out.count != count) fail("has an attribute " + name + " of another length than POSITION", "allowed are " + std::to_string(count) + " elements");
    return out;
  }

  void read_mesh(std::size_t index, const std::vector<glm::dmat4>& placed) {
    Mesh mesh;
    mesh.first_part = static_cast<std::uint32_t>(out_.parts.size());
    const std::size_t first_vertex = out_.vertices.size();
    for (const tinygltf::Primitive& primitive : model_.meshes[index].primitives) read_primitive(primitive);
    mesh.part_count = static_cast<std::uint32_t>(out_.parts.size()) - mesh.first_part;
    if (mesh.part_count == 0) return;
    mesh.first_instance = static_cast<std::uint32_t>(out_.instances.size());
    mesh.instance_count = static_cast<std::uint32_t>(placed.size());
    Box box;
    for (std::size_t v = first_vertex; v < out_.vertices.size(); ++v) box.add(out_.vertices[v].position);
    for (const glm::dmat4& transform : placed) {
      out_.instances.emplace_back(transform);
      for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                           (corner & 4) != 0 ? box.max.z : box.min.z);
        const glm::dvec3 world(transform * glm::dvec4(p, 1.0));
        for (int c = 0; c < 3; ++c) {
          if (!(std::abs(world[c]) <= kLargestCoordinate_m)) fail("reaches farther than a planet", "allowed are coordinates of up to 10000 km");
        }
        out_.bounds.add(world);
      }
    }
    out_.meshes.push_back(mesh);
  }

  void read_primitive(const tinygltf::Primitive& primitive) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
      skipped_lines_ = true;
      return;
    }
    std::size_t material = out_.materials.size() - 1;
    if (primitive.material >= 0) {
      material = static_cast<std::size_t>(primitive.material);
      if (material >= model_.materials.size()) fail("has a primitive with a material that is not there", range(model_.materials.size()));
    }
    const Values position = attribute(primitive, "POSITION", 0, 3, 3);
    if (position.data == nullptr) return;  // a primitive without positions draws nothing
    const std::vector<std::uint32_t> corners = triangles(primitive, mode, position.count);
    const Values normal = attribute(primitive, "NORMAL", position.count, 3, 3);
    // Of the set that the base colour asks for, moved as KHR_texture_transform says.
    int set = 0;
    glm::dvec2 offset(0.0), scale(1.0);
    double turn = 0.0;
    if (primitive.material >= 0) {
      texture_transform(model_.materials[material].pbrMetallicRoughness.baseColorTexture, set, offset, scale, turn);
    }
    const Values uv = attribute(primitive, "TEXCOORD_" + std::to_string(set), position.count, 2, 2);
    const Values color = attribute(primitive, "COLOR_0", position.count, 3, 4);
    const auto vertex = [&](std::size_t i) {
      MeshVertex v;
      for (int c = 0; c < 3; ++c) {
        const double x = position.real(i, c);
        if (!std::isfinite(x)) fail("has a position that is not finite", "allowed are finite numbers");
        v.position[c] = static_cast<float>(x);
      }
      if (normal.data != nullptr) {
        const glm::dvec3 n(normal.real(i, 0), normal.real(i, 1), normal.real(i, 2));
        const double length = glm::length(n);
        if (!std::isfinite(length)) fail("has a normal that is not finite", "allowed are finite numbers");
        if (length > 1e-6) v.normal = glm::vec3(n / length);
      }
      if (uv.data != nullptr) {
        const glm::dvec2 t = glm::dvec2(uv.real(i, 0), uv.real(i, 1)) * scale;
        v.uv = glm::vec2(offset + glm::dvec2(t.x * std::cos(turn) + t.y * std::sin(turn), t.y * std::cos(turn) - t.x * std::sin(turn)));
        if (!std::isfinite(v.uv.x) || !std::isfinite(v.uv.y)) fail("has a texture coordinate that is not finite", "allowed are finite numbers");
      }
      if (color.data != nullptr) {
        v.color = 0;
        for (int c = 0; c < 4; ++c) {
          const double x = c < color.components ? color.real(i, c) : 1.0;
          v.color |= static_cast<std::uint32_t>(std::lround(255.0 * (x > 0.0 ? std::min(x, 1.0) : 0.0))) << (8 * c);
        }
      }
      return v;
    };
    const std::size_t added = normal.data != nullptr ? position.count : corners.size();
    if (out_.vertices.size() + added > kMaxMeshVertices) fail("has too many vertices", "allowed are up to " + std::to_string(kMaxMeshVertices));
    if (out_.indices.size() + corners.size() > kMaxMeshIndices) fail("has too many triangles", "allowed are up to " + std::to_string(kMaxMeshIndices / 3));
    MeshPart part;
    part.first_index = static_cast<std::uint32_t>(out_.indices.size());
    part.index_count = static_cast<std::uint32_t>(corners.size());
    part.material = static_cast<std::uint32_t>(material);
    const auto base = static_cast<std::uint32_t>(out_.vertices.size());
    if (normal.data != nullptr) {
      for (std::size_t i = 0; i < position.count; ++i) out_.vertices.push_back(vertex(i));
      for (const std::uint32_t c : corners) out_.indices.push_back(base + c);
    } else {
      // Without normals triangles are flat, so no two share a vertex.
      for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
        std::array<MeshVertex, 3> v = {vertex(corners[t]), vertex(corners[t + 1]), vertex(corners[t + 2])};
        const glm::dvec3 n = glm::cross(glm::dvec3(v[1].position) - glm::dvec3(v[0].position), glm::dvec3(v[2].position) - glm::dvec3(v[0].position));
        const double length = glm::length(n);
        for (MeshVertex& one : v) {
          if (length > 0.0) one.normal = glm::vec3(n / length);
          out_.indices.push_back(static_cast<std::uint32_t>(out_.vertices.size()));
          out_.vertices.push_back(one);
        }
      }
    }
    if (part.index_count > 0) out_.parts.push_back(part);
  }

  // Corners of the triangles, three by three, whatever the mode.
  std::vector<std::uint32_t> triangles(const tinygltf::Primitive& primitive, int mode, std::size_t count) const {
    std::vector<std::uint32_t> list;
    if (primitive.indices >= 0) {
      const Values in = values(primitive.indices);
      const bool whole = in.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || in.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                         in.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
      if (!whole || in.components != 1) fail("has indices of a wrong type", "allowed are unsigned bytes, shorts and ints");
      list.reserve(in.count);
      for (std::size_t i = 0; i < in.count; ++i) {
        const std::uint64_t value = in.whole(i);
        if (value >= count) fail("has index " + std::to_string(value) + " of " + std::to_string(count) + " vertices", range(count));
        list.push_back(static_cast<std::uint32_t>(value));
      }
    } else {
      if (count > kMaxMeshVertices) fail("has too many vertices", "allowed are up to " + std::to_string(kMaxMeshVertices));
      for (std::size_t i = 0; i < count; ++i) list.push_back(static_cast<std::uint32_t>(i));
    }
    if (mode == TINYGLTF_MODE_TRIANGLES) {
      list.resize(list.size() / 3 * 3);
      return list;
    }
    std::vector<std::uint32_t> out;
    for (std::size_t i = 2; i < list.size(); ++i) {
      if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        out.insert(out.end(), {list[0], list[i - 1], list[i]});
      } else if (i % 2 == 0) {
        out.insert(out.end(), {list[i - 2], list[i - 1], list[i]});
      } else {
        out.insert(out.end(), {list[i - 1], list[i - 2], list[i]});
      }
    }
    return out;
  }

  static void texture_transform(const tinygltf::TextureInfo& info, int& set, glm::dvec2& offset, glm::dvec2& scale, double& turn) {
    set = info.texCoord;
    const auto found = info.extensions.find("KHR_texture_transform");
    if (found == info.extensions.end() || !found->second.IsObject()) return;
    const auto pair = [&](const char* name, glm::dvec2& out) {
      const tinygltf::Value& value = found->second.Get(name);
      if (!value.IsArray() || value.ArrayLen() != 2 || !value.Get(0).IsNumber() || !value.Get(1).IsNumber()) return;
      out = {value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble()};
    };
    pair("offset", offset);
    pair("scale", scale);
    if (found->second.Get("rotation").IsNumber()) turn = found->second.Get("rotation").GetNumberAsDouble();
    if (found->second.Get("texCoord").IsInt()) set = found->second.Get("texCoord").GetNumberAsInt();
  }

  static std::string range(std::size_t count) {
    return count == 0 ? "allowed is none: the file has none" : "allowed is 0 to " + std::to_string(count - 1);
  }

  const tinygltf::Model& model_;
  MeshData& out_;
  std::map<int, int> decoded_;  // image to texture
  std::uint64_t texture_bytes_ = 0, visits_ = 0, instances_ = 0;
  bool skipped_lines_ = false;
};

Error error_of(const std::string& path, const std::string& what, const std::string& allowed) {
  return Error{ErrorCode::invalid_argument, "mesh file " + config::one_line(path, 300) + " " + config::one_line(what, 400) +
               ", meshes.source, " + config::one_line(allowed, 200)};
}

// The first line of what tinygltf says, without its full stop.
std::string first_line(const std::string& text) {
  std::string line = text.substr(0, text.find('\n'));
  while (!line.empty() && (line.back() == '.' || line.back() == ' ')) line.pop_back();
  return line.empty() ? "it is damaged" : line;
}

}  // namespace

Result<MeshData> load_gltf(const std::string& path) {
  const char* const kAllowed = "allowed are none, hall, and glTF 2.0 files: .gltf or .glb";
  Result<std::string> text = config::read_file(path, kMaxFileBytes);
  if (!text.ok()) return Error{ErrorCode::io, text.error().message + ", meshes.source, " + kAllowed};
  const std::string& bytes = text.value();
  const bool binary = bytes.rfind("glTF", 0) == 0;
  std::string_view json(bytes);
  if (binary) {
    std::uint32_t length = 0;
    if (bytes.size() >= 20) std::memcpy(&length, bytes.data() + 12, 4);
    json = json.size() > 20 ? json.substr(20, length) : std::string_view();
  } else if (json.find_first_not_of(" \t\r\n\xEF\xBB\xBF") == std::string_view::npos || json[json.find_first_not_of(" \t\r\n\xEF\xBB\xBF")] != '{') {
    return error_of(path, "is no glTF file", kAllowed);
  }
  if (too_deep(json)) return error_of(path, "is nested too deeply", kAllowed);
  try {
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_bytes, nullptr);
    loader.SetFsCallbacks({exists, unchanged, read_whole, nullptr, nullptr});
    tinygltf::Model model;
    std::string error, warning;
    const std::string folder = std::filesystem::path(path).parent_path().string();
    const auto size = static_cast<unsigned>(bytes.size());
    const bool read = binary ? loader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
                             : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
    if (!read) return error_of(path, "cannot be read: " + first_line(error), kAllowed);
    MeshData out;
    Reader(model, out).read();
    return out;
  } catch (const Failure& failure) {
    return error_of(path, failure.what, failure.allowed);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_memory, "mesh file " + config::one_line(path, 300) + " does not fit into memory, meshes.source, " + kAllowed};
  } catch (const std::exception& thrown) {
    return error_of(path, std::string("cannot be read: ") + thrown.what(), kAllowed);
  }
}

}  // namespace tyndall::scene
