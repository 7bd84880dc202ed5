// Compressed glTF files, encoded here with the libraries that decode them.
#include <random>

#include "scene_gltf.hpp"

#ifdef TYNDALL_WITH_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif
#ifdef TYNDALL_WITH_MESHOPT
#include <meshoptimizer.h>
#endif

namespace tyndall::scene {
namespace {

class SceneGltfCompression : public SceneGltf {};

#ifdef TYNDALL_WITH_MESHOPT
// Returns two triangles in compressed views, whose fallback buffer has no data. The normals use a filter.
GltfFile compressed_quad(const char* mode) {
  GltfFile file;
  const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 2, 3};
  std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(4, 12));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), corners.data(), 4, 12));
  const auto add = [&](std::size_t stride, std::size_t count, const char* as, const char* filter) {
    const int view = file.view(packed.data(), packed.size());
    const json at = file.root["bufferViews"][static_cast<std::size_t>(view)];
    json compressed = {{"buffer", 0},
                       {"byteOffset", at["byteOffset"]},
                       {"byteLength", at["byteLength"]},
                       {"byteStride", stride},
                       {"count", count},
                       {"mode", as}};
    if (filter != nullptr) compressed["filter"] = filter;
    file.root["bufferViews"][static_cast<std::size_t>(view)] = {
        {"buffer", 1}, {"byteLength", stride * count}, {"extensions", {{"EXT_meshopt_compression", compressed}}}};
    return view;
  };
  const int position = add(12, 4, "ATTRIBUTES", nullptr);
  const std::vector<float> normals = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::vector<std::int8_t> octahedral(16);
  meshopt_encodeFilterOct(octahedral.data(), 4, 4, 8, normals.data());
  packed.resize(meshopt_encodeVertexBufferBound(4, 4));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), octahedral.data(), 4, 4));
  const int normal = add(4, 4, "ATTRIBUTES", "OCTAHEDRAL");
  file.root["bufferViews"][static_cast<std::size_t>(normal)]["byteStride"] = 4;
  packed.resize(meshopt_encodeIndexBufferBound(6, 4));
  packed.resize(mode == std::string("TRIANGLES")
                    ? meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices.data(), 6)
                    : meshopt_encodeIndexSequence(packed.data(), packed.size(), indices.data(), 6));
  const int index = add(2, 6, mode, nullptr);
  file.root["accessors"] = {
      {{"bufferView", position}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 4}},
      {{"bufferView", normal}, {"componentType", 5120}, {"normalized", true}, {"type", "VEC3"}, {"count", 4}},
      {{"bufferView", index}, {"componentType", 5123}, {"type", "SCALAR"}, {"count", 6}}};
  file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}, {"indices", 2}})}});
  file.root["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
  file.more_buffers = {{{"byteLength", 4 * 12}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  return file;
}

TEST_F(SceneGltfCompression, MeshoptCompressionIsRead) {
  for (const char* const mode : {"TRIANGLES", "INDICES"}) {
    const MeshData data = load(compressed_quad(mode));
    ASSERT_EQ(data.indices.size(), 6U) << mode;
    double area = 0.0;
    for (std::size_t t = 0; t < 6; t += 3) {
      const auto p = [&](std::size_t k) { return data.vertices[data.indices[t + k]].position; };
      area += 0.5 * static_cast<double>(glm::cross(p(1) - p(0), p(2) - p(0)).z);
    }
    EXPECT_DOUBLE_EQ(area, 1.0);
    EXPECT_EQ(data.bounds.max, glm::dvec3(1, 1, 0));
    for (const MeshVertex& v : data.vertices) EXPECT_EQ(v.normal, glm::vec3(0, 0, 1));
  }
  // Decoded elements have the stride of the extension, whatever their view says.
  GltfFile strides = compressed_quad("TRIANGLES");
  strides.root["bufferViews"][1].erase("byteStride");
  for (const MeshVertex& v : load(strides).vertices) EXPECT_EQ(v.normal, glm::vec3(0, 0, 1));
  strides.root["bufferViews"][1]["byteStride"] = 8;
  refuses_bytes(strides.text(), "byteStride is 8");
  const auto changed = [&](const char* name, const json& value, const std::string& part) {
    GltfFile file = compressed_quad("TRIANGLES");
    file.root["bufferViews"][2]["extensions"]["EXT_meshopt_compression"][name] = value;
    refuses_bytes(file.text(), part);
  };
  changed("mode", "POINTS", "EXT_meshopt_compression.mode is \"POINTS\"");
  changed("byteStride", 3, "EXT_meshopt_compression.byteStride is 3");
  changed("count", 7, "EXT_meshopt_compression.count is 7");
  changed("count", 9, "EXT_meshopt_compression decodes to 18 bytes");
  changed("byteLength", 4, "EXT_meshopt_compression cannot be decoded");
  GltfFile huge = compressed_quad("TRIANGLES");
  huge.root["bufferViews"][2]["extensions"]["EXT_meshopt_compression"]["count"] = 90'000'000;
  huge.root["bufferViews"][2]["byteLength"] = 180'000'000;
  huge.more_buffers[0]["byteLength"] = 180'000'000;
  refuses_bytes(huge.text(), "claims 180000000 bytes");
}
#endif

#ifdef TYNDALL_WITH_DRACO
GltfFile draco_quad() {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const std::vector<std::array<float, 3>> p = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::array<std::array<std::size_t, 3>, 2> faces = {{{0, 1, 2}, {0, 2, 3}}};
  for (std::uint32_t f = 0; f < 2; ++f) {
    const auto& [a, b, c] = faces[f];
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(f), p[a].data(), p[b].data(), p[c].data());
    builder.SetAttributeValuesForFace(uv, draco::FaceIndex(f), p[a].data(), p[b].data(), p[c].data());  // x and y
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  GltfFile file;
  const int view = file.view(buffer.data(), buffer.size());
  file.root["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}},
                            {{"componentType", 5126}, {"type", "VEC2"}, {"count", 4}},
                            {{"componentType", 5125}, {"type", "SCALAR"}, {"count", 6}}};
  const json compressed = {
      {"bufferView", view},
      {"attributes",
       {{"POSITION", mesh->attribute(position)->unique_id()}, {"TEXCOORD_0", mesh->attribute(uv)->unique_id()}}}};
  file.node({{"mesh", file.mesh({{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}},
                                 {"indices", 2},
                                 {"extensions", {{"KHR_draco_mesh_compression", compressed}}}})}});
  file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return file;
}

TEST_F(SceneGltfCompression, DracoCompressionIsRead) {
  const GltfFile file = draco_quad();
  const MeshData data = load(file);
  ASSERT_EQ(data.indices.size(), 6U);
  EXPECT_EQ(data.bounds.min, glm::dvec3(0, 0, 0));
  EXPECT_EQ(data.bounds.max, glm::dvec3(1, 1, 0));
  double area = 0.0;
  for (std::size_t t = 0; t < 6; t += 3) {
    const auto v = [&](std::size_t k) { return data.vertices[data.indices[t + k]]; };
    area += 0.5 * static_cast<double>(glm::cross(v(1).position - v(0).position, v(2).position - v(0).position).z);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(v(k).uv, glm::vec2(v(k).position));
  }
  EXPECT_DOUBLE_EQ(area, 1.0);
  const auto changed = [&](const char* pointer, const json& value, const std::string& part) {
    GltfFile wrong = file;
    wrong.root[json::json_pointer(pointer)] = value;
    refuses_bytes(wrong.text(), part);
  };
  changed("/accessors/0/count", 5, "POSITION has 4 elements");
  changed("/accessors/1/componentType", 5123, "TEXCOORD_0 has another type than its accessor");
  changed("/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/POSITION", 7,
          "attributes.POSITION is 7");
  changed("/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView", 3,
          "KHR_draco_mesh_compression.bufferView is 3");
  changed("/bufferViews/0/byteLength", 9, "KHR_draco_mesh_compression cannot be decoded");
}
#endif

#if defined(TYNDALL_WITH_MESHOPT) && defined(TYNDALL_WITH_DRACO)
TEST_F(SceneGltfCompression, DamagedCompressedDataNeverCrashes) {
  std::mt19937 engine(5);
  std::size_t refused = 0;
  for (const GltfFile& whole : {compressed_quad("TRIANGLES"), compressed_quad("INDICES"), draco_quad()}) {
    for (int i = 0; i < 150; ++i) {
      GltfFile damaged = whole;
      for (int k = 0; k < 1 + i % 3; ++k) damaged.bytes[engine() % damaged.bytes.size()] = static_cast<char>(engine());
      refused += read_bytes(damaged.text()).ok() ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 100U);
}
#endif

#if !defined(TYNDALL_WITH_MESHOPT)
TEST_F(SceneGltfCompression, MeshoptIsRefusedByNameWithoutTheLibrary) {
  refuses([](GltfFile& f) { f.root["extensionsRequired"] = {"EXT_meshopt_compression"}; },
          "EXT_meshopt_compression, whose decoder this program was built without");
}
#endif
#if !defined(TYNDALL_WITH_DRACO)
TEST_F(SceneGltfCompression, DracoIsRefusedByNameWithoutTheLibrary) {
  refuses([](GltfFile& f) { f.root["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
          "KHR_draco_mesh_compression, whose decoder this program was built without");
}
#endif

}  // namespace
}  // namespace tyndall::scene
