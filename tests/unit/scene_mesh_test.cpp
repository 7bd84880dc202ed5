// Meshes from glTF files: round trips, and one clear line for errors.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>

#include "image/image.hpp"
#include "mesh_files.hpp"
#include "scene/mesh/gltf_file.hpp"

namespace tyndall::scene {
namespace {

using nlohmann::json;

class SceneMesh : public testing::Test {
 protected:
  SceneMesh() : folder_(std::filesystem::temp_directory_path() / ("tyndall-mesh-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~SceneMesh() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(at(name), std::ios::binary) << bytes;
    return at(name);
  }
  // Returns a file with one mesh and one node.
  static GltfFile triangle() {
    GltfFile file;
    const int position = file.points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", position}}}})}});
    return file;
  }
  static MeshData load(const std::string& path) {
    Result<MeshData> read = load_gltf(path);
    EXPECT_TRUE(read.ok()) << read.error().message;
    return read.ok() ? std::move(read).value() : MeshData();
  }
  void refuses(const std::string& bytes, const std::string& part) const {
    const Result<MeshData> read = load_gltf(write("bad.gltf", bytes));
    ASSERT_FALSE(read.ok()) << part;
    EXPECT_NE(read.error().message.find(part), std::string::npos) << read.error().message;
    EXPECT_NE(read.error().message.find("bad.gltf"), std::string::npos) << read.error().message;
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
    EXPECT_NE(read.error().message.find("; expected "), std::string::npos) << read.error().message;
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(SceneMesh, TrianglesWithAndWithoutIndicesNormalsAndOfAllModes) {
  GltfFile file;
  const std::vector<Point> corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const int position = file.points(corners);
  const int normal = file.points({{0, 0, 2}, {0, 0, 2}, {0, 0, 2}, {0, 0, 2}});
  const int bytes = file.accessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, 5121, "SCALAR", 1);
  const int shorts = file.accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, 5123, "SCALAR", 1);
  const int ints = file.accessor<std::uint32_t>({0, 1, 2, 0, 2, 3}, 5125, "SCALAR", 1);
  const int strip = file.accessor<std::uint16_t>({0, 1, 3, 2}, 5123, "SCALAR", 1);
  const int fan = file.accessor<std::uint16_t>({0, 1, 2, 3}, 5123, "SCALAR", 1);
  const json with = {{"POSITION", position}, {"NORMAL", normal}};
  for (const int indices : {bytes, shorts, ints})
    file.node({{"mesh", file.mesh({{"attributes", with}, {"indices", indices}})}});
  file.node({{"mesh", file.mesh({{"attributes", with}, {"indices", strip}, {"mode", 5}})}});
  file.node({{"mesh", file.mesh({{"attributes", with}, {"indices", fan}, {"mode", 6}})}});
  file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", position}}}, {"indices", ints}})}});  // flat normals
  file.node({{"mesh", file.mesh({{"attributes", with}, {"mode", 6}})}});                            // no indices
  file.node({{"mesh", file.mesh({{"attributes", with}, {"mode", 1}})}});                            // lines
  for (const char* const name : {"a.gltf", "a.glb"}) {
    const MeshData data = load(file.save(at(name)));
    ASSERT_EQ(data.parts.size(), 7U);
    for (const MeshPart& part : data.parts) {
      ASSERT_EQ(part.index_count, 6U);
      double area = 0.0;
      for (std::uint32_t t = 0; t < 6; t += 3) {
        const auto v = [&](std::uint32_t i) { return data.vertices[data.indices[part.first_index + t + i]]; };
        const glm::vec3 cross = glm::cross(v(1).position - v(0).position, v(2).position - v(0).position);
        EXPECT_GT(cross.z, 0.0F);  // all face +z
        area += 0.5 * static_cast<double>(cross.z);
        for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(v(i).normal, glm::vec3(0, 0, 1));
      }
      EXPECT_DOUBLE_EQ(area, 1.0);
    }
    EXPECT_EQ(data.bounds.min, glm::dvec3(0.0));
    EXPECT_EQ(data.bounds.max, glm::dvec3(1.0, 1.0, 0.0));
    EXPECT_EQ(data.notes.size(), 1U);
  }
}

TEST_F(SceneMesh, QuantisedAndInterleavedAttributes) {
  GltfFile file;
  // Positions are bytes or normalised shorts, normals are bytes, and colours are bytes or shorts.
  const int bytes = file.accessor<std::int8_t>({0, 0, 0, 127, 0, 0, 0, -127, 0}, 5120, "VEC3", 3);
  const int shorts = file.accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 0, -32767, 0}, 5122, "VEC3", 3, true);
  const int normals = file.accessor<std::int8_t>({0, 0, -127, 0, 0, -127, 0, 0, -127}, 5120, "VEC3", 3, true);
  const int uv = file.accessor<std::uint16_t>({0, 0, 65535, 0, 0, 65535}, 5123, "VEC2", 2, true);
  const int color = file.accessor<std::uint8_t>({255, 0, 128, 255, 0, 128, 255, 0, 128}, 5121, "VEC3", 3, true);
  file.node(
      {{"mesh", file.mesh({{"attributes",
                            {{"POSITION", bytes}, {"NORMAL", normals}, {"TEXCOORD_0", uv}, {"COLOR_0", color}}}})}});
  file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", shorts}}}})}});
  // Elements are four floats apart: x, y, z and padding.
  const std::vector<float> loose = {1, 2, 3, 9, 4, 5, 6, 9, 7, 8, 10, 9};
  const int view = file.view(loose.data(), loose.size() * sizeof(float));
  file.root["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 16;
  file.root["accessors"].push_back({{"bufferView", view}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
  file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", file.root["accessors"].size() - 1}}}})}});
  const MeshData data = load(file.save(at("a.glb")));
  ASSERT_EQ(data.vertices.size(), 9U);
  EXPECT_EQ(data.vertices[1].position, glm::vec3(127, 0, 0));
  EXPECT_EQ(data.vertices[0].normal, glm::vec3(0, 0, -1));
  EXPECT_EQ(data.vertices[1].uv, glm::vec2(1, 0));
  EXPECT_EQ(data.vertices[0].color, (MeshColor{0xFFFF, 0, 128 * 257, 0xFFFF}));
  EXPECT_EQ(data.vertices[5].position, glm::vec3(0, -1, 0));
  EXPECT_EQ(data.vertices[8].position, glm::vec3(7, 8, 10));
}

TEST_F(SceneMesh, NodesPlaceAndRepeatMeshes) {
  GltfFile file = triangle();
  // A child beside its parent: rotated by 90 degrees about y, scaled, moved.
  const int child = file.node({{"mesh", 0}, {"translation", {0, 0, 1}}}, false);
  file.node({{"children", {child}},
             {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
             {"scale", {2, 2, 2}},
             {"translation", {10, 0, 0}}});
  const MeshData data = load(file.save(at("a.gltf")));
  ASSERT_EQ(data.meshes.size(), 1U);
  ASSERT_EQ(data.instances.size(), 2U);
  EXPECT_EQ(data.meshes[0].instance_count, 2U);
  const glm::vec4 moved = data.instances[1] * glm::vec4(0, 0, 0, 1);  // (0, 0, 1) becomes (2, 0, 0)
  EXPECT_NEAR(glm::distance(glm::vec3(moved), glm::vec3(12, 0, 0)), 0.0, 1e-5);
  EXPECT_NEAR(data.bounds.max.x, 12.0, 1e-5);
  // Without a scene the roots are drawn.
  file.root.erase("scenes");
  file.root.erase("scene");
  EXPECT_EQ(load(file.save(at("b.gltf"))).instances.size(), 2U);
}

TEST_F(SceneMesh, MaterialsAndTextures) {
  image::Image picture(2, 1);
  picture.rgb = {1, 0, 0, 0, 0, 1};
  ASSERT_TRUE(image::write_png(at("red blue.png"), picture, {}).ok());
  std::ifstream png(at("red blue.png"), std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(png)), std::istreambuf_iterator<char>());
  GltfFile file = triangle();
  const int inside = file.view(bytes.data(), bytes.size());
  file.root["images"] = {{{"uri", "red%20blue.png"}},
                         {{"uri", "data:image/png;base64," + GltfFile::base64(bytes)}},
                         {{"bufferView", inside}, {"mimeType", "image/png"}}};
  file.root["textures"] = {{{"source", 0}}, {{"source", 1}}, {{"source", 2}}};
  const auto textured = [](int texture) {
    return json{{"baseColorTexture", {{"index", texture}}}, {"baseColorFactor", {0.5, 0.25, 1, 0.75}}};
  };
  file.material(
      {{"pbrMetallicRoughness", textured(0)}, {"alphaMode", "MASK"}, {"alphaCutoff", 0.25}, {"doubleSided", true}});
  file.material({{"pbrMetallicRoughness", textured(1)}, {"alphaMode", "BLEND"}});
  file.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 2}}}, {"roughnessFactor", 0.1}}},
                 {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}}}});
  for (const char* const name : {"a.gltf", "a.glb"}) {
    const MeshData data = load(file.save(at(name)));
    ASSERT_EQ(data.materials.size(), 4U);
    EXPECT_EQ(data.materials[0].kind, SurfaceKind::mask);
    EXPECT_TRUE(data.materials[0].double_sided);
    EXPECT_EQ(data.materials[0].alpha_cutoff, 0.25F);
    EXPECT_EQ(data.materials[0].color, glm::vec4(0.5F, 0.25F, 1.0F, 0.75F));
    EXPECT_EQ(data.materials[1].kind, SurfaceKind::blend);
    EXPECT_EQ(data.materials[2].kind, SurfaceKind::glass);
    EXPECT_EQ(data.materials[2].transmission, 0.5F);
    EXPECT_TRUE(data.materials[2].transmits());
    EXPECT_FALSE(data.materials[2].diffuses());
    ASSERT_EQ(data.textures.size(), 3U);
    for (const MeshTexture& texture : data.textures) {
      ASSERT_EQ(texture.width, 2U);
      ASSERT_EQ(texture.height, 1U);
      const std::uint8_t expected[] = {255, 0, 0, 255, 0, 0, 255, 255};
      for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(texture.rgba[i], expected[i], 1) << i;  // PNGs are dithered
    }
  }
}

TEST_F(SceneMesh, InvalidFilesAreReportedWithTheirError) {
  refuses("", "is not a glTF file");
  refuses("not glTF at all", "is not a glTF file");
  refuses("{", "cannot be read");
  refuses("{}", "asset is missing");
  refuses(std::string("glTF\2\0\0\0", 8), "ends within the header");
  refuses("{\"asset\":{\"version\":\"2.0\"}}", "no triangles");
  std::string deep = "{\"asset\":{\"version\":\"2.0\"},\"extras\":";
  for (int i = 0; i < 100000; ++i) deep += "[";
  refuses(deep, "nested too deeply");

  const auto changed = [](const std::function<void(GltfFile&)>& change) {
    GltfFile file = triangle();
    change(file);
    return file.text();
  };
  refuses(changed([](GltfFile& f) { f.root["nodes"][0]["mesh"] = 7; }), "nodes[0].mesh is 7");
  refuses(changed([](GltfFile& f) { f.root["scene"] = 7; }), "scene is 7");
  refuses(changed([](GltfFile& f) { f.root["scenes"][0]["nodes"] = {9}; }), "scenes[0].nodes[0] is 9");
  refuses(changed([](GltfFile& f) { f.root["nodes"][0]["children"] = {0}; }), "in a circle");
  refuses(changed([](GltfFile& f) {
            f.root["nodes"][0]["rotation"] = {0, 0, 0, 0};
          }),
          "nodes[0].rotation has no length");
  refuses(changed([](GltfFile& f) { f.root["accessors"][0]["count"] = 4; }), "beyond the end of its bufferView");
  refuses(changed([](GltfFile& f) { f.root["accessors"][0]["count"] = 4000000000U; }), "accessors[0]");
  refuses(changed([](GltfFile& f) { f.root["accessors"][0]["byteOffset"] = 4000000000U; }),
          "beyond the end of its bufferView");
  refuses(changed([](GltfFile& f) { f.root["bufferViews"][0]["byteLength"] = 4000000000U; }),
          "beyond the end of its buffer");
  refuses(changed([](GltfFile& f) { f.root["bufferViews"][0]["buffer"] = 3; }), "bufferViews[0].buffer is 3");
  refuses(changed([](GltfFile& f) { f.root["meshes"][0]["primitives"][0]["indices"] = 0; }), "indices of a wrong type");
  refuses(changed([](GltfFile& f) {
            f.root["meshes"][0]["primitives"][0]["indices"] = f.accessor<std::uint16_t>({0, 1, 3}, 5123, "SCALAR", 1);
          }),
          "index 3 of 3 vertices");
  refuses(changed([](GltfFile& f) { f.root["meshes"][0]["primitives"][0]["material"] = 3; }),
          "meshes[0].primitives[0].material is 3");
  refuses(changed([](GltfFile& f) {
            f.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = f.points({{0, 0, 1}});
          }),
          "another length than POSITION");
  refuses(changed([](GltfFile& f) {
            f.material({{"alphaMode", "PERHAPS"}});
          }),
          "materials[0].alphaMode is \"PERHAPS\"");
  refuses(changed([](GltfFile& f) {
            f.material({{"alphaMode", "MASK"}, {"alphaCutoff", -0.5}});
          }),
          "materials[0].alphaCutoff is -0.5");
  const float infinite[] = {0, 0, std::numeric_limits<float>::quiet_NaN()};
  refuses(changed([&](GltfFile& f) { std::memcpy(f.bytes.data(), infinite, sizeof infinite); }),
          "meshes[0].primitives[0].attributes.POSITION (accessors[0]) has an element that is not finite");
  refuses(changed([](GltfFile& f) { f.root["nodes"][0]["scale"] = {1e30, 1, 1}; }), "farther than a planet");
  const auto textured = [&](const json& images) {
    return changed([&](GltfFile& f) {
      f.root["images"] = images;
      f.root["textures"] = {{{"source", 0}}};
      f.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    });
  };
  refuses(textured({{{"uri", "missing.png"}}}), "missing.png': cannot read");
  refuses(textured({{{"uri", "data:image/png;base64,QUJDREVGRw=="}}}), "is not a picture");
  refuses(textured({{{"bufferView", 9}, {"mimeType", "image/png"}}}), "images[0].bufferView is 9");
  refuses(textured(json::array({json::object()})), "images[0] is not a picture");
  GltfFile outside = triangle();
  outside.root["buffers"] = {{{"byteLength", 36}, {"uri", "missing.bin"}}};
  refuses(outside.root.dump(), "missing.bin");
  EXPECT_FALSE(load_gltf("/nonexistent.gltf").ok());
  EXPECT_FALSE(load_gltf("/").ok());
}

// Every input gives a mesh or an error, without a fault that a sanitizer would report.
TEST_F(SceneMesh, CutAndDamagedFilesNeverCrash) {
  GltfFile file = triangle();
  const int position = file.points({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const int indices = file.accessor<std::uint8_t>({0, 1, 2, 0, 2, 3}, 5121, "SCALAR", 1);
  const int material =
      file.material({{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  image::Image picture(4, 4);
  ASSERT_TRUE(image::write_png(at("p.png"), picture, {}).ok());
  std::ifstream png(at("p.png"), std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(png)), std::istreambuf_iterator<char>());
  file.root["images"] = {{{"bufferView", file.view(bytes.data(), bytes.size())}, {"mimeType", "image/png"}}};
  file.root["textures"] = {{{"source", 0}}};
  file.node(
      {{"mesh", file.mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}, {"material", material}})}});
  std::mt19937 engine(3);
  std::size_t refused = 0;
  for (const std::string& whole : {file.binary(), file.text()}) {
    ASSERT_TRUE(load_gltf(write("w", whole)).ok());
    for (std::size_t cut = 0; cut < whole.size(); cut += 1 + whole.size() / 200) {
      refused += load_gltf(write("w", whole.substr(0, cut))).ok() ? 0 : 1;
    }
    for (int i = 0; i < 600; ++i) {
      std::string damaged = whole;
      for (int k = 0; k < 1 + i % 3; ++k) {
        char& at_random = damaged[engine() % damaged.size()];
        // Replace digits by other digits, so that some files can be parsed but have wrong numbers.
        at_random =
            at_random >= '0' && at_random <= '9' ? static_cast<char>('0' + engine() % 10) : static_cast<char>(engine());
      }
      refused += load_gltf(write("w", damaged)).ok() ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 400U);
}

}  // namespace
}  // namespace tyndall::scene
