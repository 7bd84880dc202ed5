// A fixture for tests of glTF files: small files, loaded from a temporary folder.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "image/image.hpp"
#include "mesh_files.hpp"
#include "scene/mesh/gltf_file.hpp"

namespace tyndall::scene {

using nlohmann::json;

inline const std::vector<Point> kGltfCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

class SceneGltf : public testing::Test {
 protected:
  SceneGltf() : folder_(std::filesystem::temp_directory_path() / ("tyndall-gltf-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~SceneGltf() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] Result<MeshData> read_bytes(const std::string& bytes) const {
    std::ofstream(at("a.gltf"), std::ios::binary) << bytes;
    return load_gltf(at("a.gltf"));
  }
  [[nodiscard]] MeshData load(const GltfFile& file) const {
    Result<MeshData> read = read_bytes(file.text());
    EXPECT_TRUE(read.ok()) << read.error().message;
    return read.ok() ? std::move(read).value() : MeshData();
  }
  void refuses_bytes(const std::string& bytes, const std::string& part) const {
    const Result<MeshData> read = read_bytes(bytes);
    ASSERT_FALSE(read.ok()) << part;
    EXPECT_NE(read.error().message.find(part), std::string::npos) << read.error().message << "\nexpected: " << part;
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
    EXPECT_NE(read.error().message.find("; expected "), std::string::npos) << read.error().message;
  }
  void refuses(const std::function<void(GltfFile&)>& change, const std::string& part) const {
    GltfFile file = triangle();
    change(file);
    refuses_bytes(file.text(), part);
  }
  static void expect_note(const MeshData& data, const std::string& part) {
    std::size_t found = 0;
    for (const std::string& note : data.notes) found += note.find(part) != std::string::npos ? 1 : 0;
    EXPECT_EQ(found, 1U) << part << ", notes: " << json(data.notes).dump();
  }
  // Returns a file with one mesh, one material and one node.
  static GltfFile triangle() {
    GltfFile file;
    const int material = file.material({{"pbrMetallicRoughness", json::object()}});
    const int position = file.points(kGltfCorners);
    file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", position}}}, {"material", material}})}});
    return file;
  }
  static json& primitive(GltfFile& file) { return file.root["meshes"][0]["primitives"][0]; }
  // Adds a picture in a buffer view of the file as the base colour of materials[0].
  static void set_picture(GltfFile& file, const std::string& bytes) {
    file.root["images"] = {{{"bufferView", file.view(bytes.data(), bytes.size())}, {"mimeType", "image/png"}}};
    file.root["textures"] = {{{"source", 0}}};
    file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  }
  [[nodiscard]] std::string picture() const {
    image::Image picture(2, 1);
    picture.rgb = {1, 0, 0, 0, 0, 1};
    EXPECT_TRUE(image::write_png(at("p.png"), picture, {}).ok());
    std::ifstream png(at("p.png"), std::ios::binary);
    return {std::istreambuf_iterator<char>(png), std::istreambuf_iterator<char>()};
  }
  static std::vector<glm::vec3> positions(const MeshData& data) {
    std::vector<glm::vec3> out;
    for (const std::uint32_t i : data.indices) out.push_back(data.vertices[i].position);
    return out;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace tyndall::scene
