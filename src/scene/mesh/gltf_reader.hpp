// What a parsed glTF file holds, checked and turned into MeshData: materials and pictures in gltf_materials.cpp, nodes
// in gltf_nodes.cpp, triangles in gltf_geometry.cpp. Seen by these and gltf_file.cpp only.
#pragma once

#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_STB_IMAGE
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop

#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene/mesh/mesh_data.hpp"

namespace tyndall::scene {

// Of what is wrong with a file; load_gltf() makes an error of it.
struct GltfFailure {
  std::string what, allowed;
};

[[noreturn]] inline void fail(std::string what, std::string allowed) { throw GltfFailure{std::move(what), std::move(allowed)}; }

inline std::string at(const char* list, std::size_t index) { return std::string(list) + "[" + std::to_string(index) + "]"; }

class GltfReader {
 public:
  GltfReader(const tinygltf::Model& model, MeshData& out) : model_(model), out_(out) {}

  // Throws GltfFailure.
  void read();

 private:
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

  void check_extensions() const;

  void read_materials();
  MeshMaterial material(std::size_t index);
  static double bounded(double value, std::size_t index, const char* name);
  int texture(std::size_t index, std::size_t material);

  static glm::dmat4 transform(const tinygltf::Node& node, std::size_t index);
  void place(std::vector<std::vector<glm::dmat4>>& placed);
  void visit(int index, const glm::dmat4& parent, int depth, std::vector<std::vector<glm::dmat4>>& placed);

  std::span<const unsigned char> view_bytes(std::size_t index) const;
  Values values(int index) const;
  Values attribute(const tinygltf::Primitive& primitive, const std::string& name, std::size_t count, int least, int most) const;
  void read_mesh(std::size_t index, const std::vector<glm::dmat4>& placed);
  void read_primitive(const tinygltf::Primitive& primitive);
  std::vector<std::uint32_t> triangles(const tinygltf::Primitive& primitive, int mode, std::size_t count) const;
  static void texture_transform(const tinygltf::TextureInfo& info, int& set, glm::dvec2& offset, glm::dvec2& scale, double& turn);
  static std::string range(std::size_t count);

  const tinygltf::Model& model_;
  MeshData& out_;
  std::map<int, int> decoded_;  // image to texture
  std::uint64_t texture_bytes_ = 0, visits_ = 0, instances_ = 0;
  bool skipped_lines_ = false;
};

}  // namespace tyndall::scene
