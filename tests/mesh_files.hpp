// Writes small glTF files for tests, with one buffer each.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tyndall {

using Point = std::array<float, 3>;

class GltfFile {
 public:
  nlohmann::json root = {
      {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", nlohmann::json::array()}}}}};
  std::string bytes;                                      // contents of the buffer
  nlohmann::json more_buffers = nlohmann::json::array();  // additional buffers

  int view(const void* data, std::size_t size) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}});
    bytes.append(static_cast<const char*>(data), size);
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }
  // Adds an accessor with these values. `component` is the number of the component type in glTF.
  template <typename T>
  int accessor(const std::vector<T>& values, int component, const char* type, int components, bool normalized = false) {
    const int at = view(values.data(), values.size() * sizeof(T));
    root["accessors"].push_back({{"bufferView", at},
                                 {"componentType", component},
                                 {"type", type},
                                 {"count", values.size() / static_cast<std::size_t>(components)},
                                 {"normalized", normalized}});
    return static_cast<int>(root["accessors"].size()) - 1;
  }
  int floats(const std::vector<float>& values, int components) {
    constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    return accessor(values, 5126, kTypes[components], components);
  }
  int points(const std::vector<Point>& values) {
    std::vector<float> flat;
    for (const Point& p : values) flat.insert(flat.end(), p.begin(), p.end());
    return floats(flat, 3);
  }
  int material(const nlohmann::json& material) {
    root["materials"].push_back(material);
    return static_cast<int>(root["materials"].size()) - 1;
  }
  int mesh(const nlohmann::json& primitive) {
    root["meshes"].push_back({{"primitives", {primitive}}});
    return static_cast<int>(root["meshes"].size()) - 1;
  }
  int node(nlohmann::json node, bool in_scene = true) {
    root["nodes"].push_back(std::move(node));
    const int index = static_cast<int>(root["nodes"].size()) - 1;
    if (in_scene) root["scenes"][0]["nodes"].push_back(index);
    return index;
  }
  // Adds a quad with corners in counter-clockwise order and texture coordinates; `a` is the lower left corner of the
  // picture.
  int quad(const Point& a, const Point& b, const Point& c, const Point& d, int material) {
    const int position = points({a, b, c, d});
    const int uv = floats({0, 1, 1, 1, 1, 0, 0, 0}, 2);
    const int indices = accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, 5123, "SCALAR", 1);
    const int made = mesh(
        {{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}}, {"indices", indices}, {"material", material}});
    return node({{"mesh", made}});
  }
  int level_quad(float x0, float z0, float x1, float z1, float y, int material) {
    return quad({x0, y, z1}, {x1, y, z1}, {x1, y, z0}, {x0, y, z0}, material);
  }

  [[nodiscard]] std::string text() const {
    nlohmann::json out = root;
    out["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    for (const nlohmann::json& buffer : more_buffers) out["buffers"].push_back(buffer);
    return out.dump();
  }
  [[nodiscard]] std::string binary() const {
    nlohmann::json out = root;
    std::string data = bytes;
    data.resize((data.size() + 3) / 4 * 4);
    out["buffers"] = {{{"byteLength", data.size()}}};
    for (const nlohmann::json& buffer : more_buffers) out["buffers"].push_back(buffer);
    std::string json = out.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string file = "glTF";
    const auto word = [&](std::size_t value) {
      const auto w = static_cast<std::uint32_t>(value);
      file.append(reinterpret_cast<const char*>(&w), 4);
    };
    word(2);
    word(28 + json.size() + data.size());
    word(json.size());
    file += "JSON" + json;
    word(data.size());
    file += std::string("BIN\0", 4) + data;
    return file;
  }
  std::string save(const std::string& path) const {
    std::ofstream(path, std::ios::binary) << (path.ends_with(".glb") ? binary() : text());
    return path;
  }

  static std::string base64(const std::string& data) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < data.size(); i += 3) {
      std::uint32_t bits = 0;
      for (std::size_t k = 0; k < 3; ++k)
        bits = bits << 8U | (i + k < data.size() ? static_cast<std::uint8_t>(data[i + k]) : 0U);
      for (std::size_t k = 0; k < 4; ++k) out += i + k > data.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63U];
    }
    return out;
  }
};

}  // namespace tyndall
