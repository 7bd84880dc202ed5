// Meshes from glTF files: round trips, and one clear line for errors; and the hall, which light enters only through
// glass.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>

#include "image/image.hpp"
#include "mesh_files.hpp"
#include "scene/mesh/cull.hpp"
#include "scene/mesh/gltf_file.hpp"
#include "scene/mesh/hall.hpp"

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
  EXPECT_EQ(data.vertices[0].color, 0xFF8000FFU);
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

// Returns the first triangle that a ray hits, or -1.
int first_hit(const MeshData& data, const glm::dvec3& from, const glm::dvec3& direction, double& nearest) {
  int hit = -1;
  nearest = std::numeric_limits<double>::max();
  for (std::size_t t = 0; t + 2 < data.indices.size(); t += 3) {
    const glm::dvec3 a(data.vertices[data.indices[t]].position);
    const glm::dvec3 e1 = glm::dvec3(data.vertices[data.indices[t + 1]].position) - a;
    const glm::dvec3 e2 = glm::dvec3(data.vertices[data.indices[t + 2]].position) - a;
    const glm::dvec3 p = glm::cross(direction, e2);
    const double det = glm::dot(e1, p);
    if (std::abs(det) < 1e-12) continue;
    const glm::dvec3 s = from - a;
    const double u = glm::dot(s, p) / det;
    const glm::dvec3 q = glm::cross(s, e1);
    const double v = glm::dot(direction, q) / det;
    const double d = glm::dot(e2, q) / det;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || d <= 0.0 || d >= nearest) continue;
    nearest = d;
    hit = static_cast<int>(t);
  }
  return hit;
}

TEST_F(SceneMesh, TheHallIsClosedAndSeenFromInside) {
  const MeshData hall = make_hall();
  EXPECT_NEAR(hall.bounds.min.y, 0.0, 1e-9);
  EXPECT_LT(hall.bounds.max.y, 17.0);
  ASSERT_FALSE(hall.parts.empty());
  for (const std::uint32_t index : hall.indices) ASSERT_LT(index, hall.vertices.size());
  for (const MeshVertex& v : hall.vertices) ASSERT_NEAR(glm::length(v.normal), 1.0F, 1e-4F);
  const auto material_of = [&](int triangle) -> const MeshMaterial& {
    for (const MeshPart& part : hall.parts) {
      if (static_cast<std::uint32_t>(triangle) >= part.first_index &&
          static_cast<std::uint32_t>(triangle) < part.first_index + part.index_count) {
        return hall.materials[part.material];
      }
    }
    return hall.materials.back();
  };
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int glass = 0;
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 from(-2.8 + 5.6 * unit(engine), 1.2 + 6.0 * unit(engine), -17.0 + 34.0 * unit(engine));
    const double z = 2.0 * unit(engine) - 1.0;
    const double angle = 6.283185307179586 * unit(engine);
    const glm::dvec3 direction(std::sqrt(1.0 - z * z) * std::cos(angle), z, std::sqrt(1.0 - z * z) * std::sin(angle));
    double distance = 0.0;
    const int hit = first_hit(hall, from, direction, distance);
    ASSERT_GE(hit, 0) << "a hole: from " << from.x << " " << from.y << " " << from.z << " towards " << direction.x
                      << " " << direction.y << " " << direction.z;
    const MeshMaterial& material = material_of(hit);
    glass += material.transmits() ? 1 : 0;
    const auto p = [&](int k) {
      return glm::dvec3(hall.vertices[hall.indices[static_cast<std::size_t>(hit + k)]].position);
    };
    const double facing = glm::dot(glm::cross(p(1) - p(0), p(2) - p(0)), direction);
    if (facing > 0.0 && !material.double_sided) {
      const glm::dvec3 where = from + direction * distance;
      ADD_FAILURE() << material.name << " seen from behind at " << where.x << " " << where.y << " " << where.z;
    }
  }
  EXPECT_GT(glass, 60);
}

// Boxes with a visible point are never left out; boxes entirely on the outer side of one plane are.
TEST(SceneMeshCulling, CullsOnlyInvisibleBoxes) {
  std::mt19937 engine(6);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  int outside = 0;
  for (int i = 0; i < 2000; ++i) {
    // A perspective along -z with an infinite far plane, or a box as for a cascade; rotated and moved.
    glm::dmat4 clip(0.0);
    clip[0][0] = uniform(0.5, 3.0);
    clip[1][1] = uniform(0.5, 3.0);
    if (i % 2 == 0) {
      clip[2][3] = -1.0;
      clip[3][2] = 0.5;
    } else {
      clip[0][0] *= 0.1;
      clip[1][1] *= 0.1;
      clip[3][3] = 1.0;
    }
    const double turn = uniform(0.0, 6.28);
    const glm::dmat4 view(std::cos(turn), 0, std::sin(turn), 0, 0, 1, 0, 0, -std::sin(turn), 0, std::cos(turn), 0,
                          uniform(-20, 20), uniform(-20, 20), uniform(-20, 20), 1);
    clip = clip * view;
    Box box;
    const glm::dvec3 corner(uniform(-30, 30), uniform(-30, 30), uniform(-30, 30));
    box.add(corner);
    box.add(corner + glm::dvec3(uniform(0, 20), uniform(0, 20), uniform(0, 20)));
    const bool left_out = is_outside(sides_of(clip), box);
    outside += left_out ? 1 : 0;
    for (int k = 0; k < 64 && left_out; ++k) {
      const glm::dvec3 p = glm::mix(box.min, box.max, glm::dvec3(uniform(0, 1), uniform(0, 1), uniform(0, 1)));
      const glm::dvec4 seen = clip * glm::dvec4(p, 1.0);
      EXPECT_FALSE(std::abs(seen.x) <= seen.w && std::abs(seen.y) <= seen.w) << i;
    }
    // Behind the camera or beside the cascade, no point of a small box is visible.
    Box point;
    point.add(corner);
    const glm::dvec4 seen = clip * glm::dvec4(corner, 1.0);
    EXPECT_EQ(is_outside(sides_of(clip), point), std::abs(seen.x) > seen.w || std::abs(seen.y) > seen.w) << i;
  }
  EXPECT_GT(outside, 400);
  EXPECT_LT(outside, 1900);
  // A transformed box contains its corners, also when mirrored and rotated.
  const glm::dmat4 place(0, 2, 0, 0, -3, 0, 0, 0, 0, 0, -1, 0, 5, 6, 7, 1);
  Box box;
  box.add(glm::dvec3(-1, -2, -3));
  box.add(glm::dvec3(4, 5, 6));
  const Box placed = placed_box(place, box);
  EXPECT_LE(glm::distance(placed.min, glm::dvec3(-10, 4, 1)), 0.01);
  EXPECT_LE(glm::distance(placed.max, glm::dvec3(11, 14, 10)), 0.01);
}

}  // namespace
}  // namespace tyndall::scene
