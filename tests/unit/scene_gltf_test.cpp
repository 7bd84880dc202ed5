// glTF files are drawn as specified, or a note names what is not: samplers, morph targets, skins and sparse data.
// Violations of the schema are rejected with the path of the value.
#include <sys/resource.h>
#include <zlib.h>

#include <cmath>
#include <limits>

#include "../sanitizers.hpp"
#include "scene_gltf.hpp"

// To write JPEG files for these tests.
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace tyndall::scene {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST_F(SceneGltf, SamplersAreThoseOfTheFile) {
  GltfFile file = triangle();
  set_picture(file, picture());
  file.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9728}},
                           {{"minFilter", 9985}},
                           json::object()};
  file.root["textures"] = {{{"source", 0}, {"sampler", 0}},
                           {{"source", 0}, {"sampler", 1}},
                           {{"source", 0}, {"sampler", 2}},
                           {{"source", 0}}};
  for (int i = 1; i < 4; ++i) file.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
  const MeshData data = load(file);
  ASSERT_GE(data.materials.size(), 4U);
  EXPECT_EQ(data.textures.size(), 1U);  // one picture for all samplers
  EXPECT_EQ(data.materials[0].sampler,
            (MeshSampler{TextureWrap::clamp_to_edge, TextureWrap::mirrored_repeat, false, false, MipFilter::none}));
  EXPECT_EQ(data.materials[1].sampler,
            (MeshSampler{TextureWrap::repeat, TextureWrap::repeat, true, true, MipFilter::nearest}));
  EXPECT_EQ(data.materials[2].sampler, MeshSampler());
  EXPECT_EQ(data.materials[3].sampler, MeshSampler());
  for (const auto& [name, value] :
       {std::pair("wrapS", 33072), std::pair("wrapT", 0), std::pair("magFilter", 9987), std::pair("minFilter", 9730)}) {
    refuses(
        [&, key = name, number = value](GltfFile& f) {
          f.root["samplers"] = {{{key, number}}};
        },
        "samplers[0]." + std::string(name) + " is " + std::to_string(value));
  }
}

TEST_F(SceneGltf, MorphTargetsHaveTheirDefaultWeights) {
  GltfFile file = triangle();
  const int up = file.points({{0, 0, 4}, {0, 0, 4}, {0, 0, 4}});
  const int aside = file.points({{8, 0, 0}, {8, 0, 0}, {8, 0, 0}});
  primitive(file)["targets"] = {{{"POSITION", up}}, {{"POSITION", aside}}};
  EXPECT_EQ(load(file).bounds.max, glm::dvec3(1, 1, 0));  // without weights the targets have no effect
  file.root["meshes"][0]["weights"] = {0.5, 0.0};
  EXPECT_EQ(load(file).bounds.min, glm::dvec3(0, 0, 2));
  // A node's weights replace those of its mesh, which other nodes still use.
  file.node({{"mesh", 0}, {"weights", {0.0, 1.0}}});
  const MeshData data = load(file);
  EXPECT_EQ(data.meshes.size(), 2U);
  EXPECT_EQ(data.bounds.min, glm::dvec3(0, 0, 0));
  EXPECT_EQ(data.bounds.max, glm::dvec3(9, 1, 2));
  file.root["nodes"][1]["weights"] = {1.0};
  refuses_bytes(file.text(), "nodes[1].weights is an array of 1");
  file.root["nodes"][1].erase("weights");
  file.root["meshes"][0]["weights"] = {1.0, 0.0, 0.0};
  refuses_bytes(file.text(), "meshes[0].weights is an array of 3");
}

TEST_F(SceneGltf, MorphTargetsMoveNormalsCoordinatesAndColours) {
  GltfFile file = triangle();
  primitive(file)["attributes"]["NORMAL"] = file.points({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
  primitive(file)["attributes"]["TEXCOORD_0"] = file.floats({0, 0, 1, 0, 0, 1}, 2);
  primitive(file)["attributes"]["COLOR_0"] = file.floats({0, 0, 0, 0, 0, 0, 0, 0, 0}, 3);
  primitive(file)["targets"] = {{{"NORMAL", file.points({{1, 0, -1}, {1, 0, -1}, {1, 0, -1}})},
                                 {"TEXCOORD_0", file.floats({2, 0, 2, 0, 2, 0}, 2)},
                                 {"COLOR_0", file.floats({1, 0, 9, 1, 0, 9, 1, 0, 9}, 3)}}};
  file.root["meshes"][0]["weights"] = {1.0};
  const MeshData data = load(file);
  ASSERT_EQ(data.vertices.size(), 3U);
  EXPECT_EQ(data.vertices[0].normal, glm::vec3(1, 0, 0));
  EXPECT_EQ(data.vertices[1].uv, glm::vec2(3, 0));
  EXPECT_EQ(data.vertices[0].color, (MeshColor{0xFFFF, 0, 0xFFFF, 0xFFFF}));
}

TEST_F(SceneGltf, NormalsOfZeroLengthAreReplaced) {
  GltfFile file = triangle();
  // The fourth vertex belongs to no triangle.
  primitive(file)["attributes"]["POSITION"] = file.points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}});
  primitive(file)["attributes"]["NORMAL"] = file.points({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  const MeshData data = load(file);
  ASSERT_EQ(data.vertices.size(), 4U);
  const std::vector<glm::vec3> expected = {{0, 0, 1}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(data.vertices[i].normal, expected[i]) << i;
}

TEST_F(SceneGltf, SpecularGlossinessIsDrawnWithItsDiffuseColour) {
  GltfFile file = triangle();
  file.root["materials"][0] = {
      {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 1, 1}}}},
      {"extensions",
       {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {0.5, 0.25, 0, 1}}, {"glossinessFactor", 0.75}}}}}};
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
  const MeshData data = load(file);
  ASSERT_FALSE(data.materials.empty());
  EXPECT_EQ(data.materials[0].color, glm::vec4(0.5F, 0.25F, 0.0F, 1.0F));
  EXPECT_EQ(data.materials[0].roughness, 0.25F);
  expect_note(data, "KHR_materials_pbrSpecularGlossiness");
}

TEST_F(SceneGltf, VersionsThatAreNotReadAreRefused) {
  for (const char* const version : {"1.0", "3.0", "2", "two", "2.0.1"}) {
    refuses([&](GltfFile& f) { f.root["asset"]["version"] = version; }, "asset.version is \"" + std::string(version));
  }
  refuses([](GltfFile& f) { f.root["asset"]["version"] = 2.0; }, "asset.version is 2.0");
  refuses([](GltfFile& f) { f.root["asset"]["minVersion"] = "2.1"; }, "asset.minVersion is \"2.1\"");
  GltfFile file = triangle();
  file.root["asset"] = {{"version", "2.1"}, {"minVersion", "2.0"}};
  EXPECT_FALSE(load(file).indices.empty());
  std::string binary = triangle().binary();
  ASSERT_TRUE(read_bytes(binary).ok());
  binary[4] = 1;
  refuses_bytes(binary, "a .glb of version 1");
  binary[4] = 2;
  refuses_bytes(binary.substr(0, binary.size() - 4), "states " + std::to_string(binary.size()) + " bytes");
  const Result<MeshData> longer = read_bytes(binary + "tail");
  ASSERT_TRUE(longer.ok());
  expect_note(longer.value(), "bytes after the end");
}

// Values must have the types, lengths and ranges of the schema; none may be skipped silently.
TEST_F(SceneGltf, ValuesOutsideTheSchemaAreRefusedWithTheirPath) {
  const auto set = [&](const char* pointer, const json& value, const std::string& part) {
    refuses([&](GltfFile& f) { f.root[json::json_pointer(pointer)] = value; }, part);
  };
  set("/bufferViews/0/byteOffset", -16, "bufferViews[0].byteOffset is -16");
  set("/bufferViews/0/byteOffset", "0", "bufferViews[0].byteOffset is \"0\"");
  set("/bufferViews/0/byteStride", -12, "bufferViews[0].byteStride is -12");
  set("/bufferViews/0/byteStride", 14, "bufferViews[0].byteStride is 14");
  set("/bufferViews/0/byteStride", 8, "accessors[0] has elements of 12 bytes");
  set("/bufferViews/0/byteLength", 0, "bufferViews[0].byteLength is 0");
  set("/bufferViews/0/buffer", 0.5, "bufferViews[0].buffer is 0.5");
  set("/accessors/0/byteOffset", -4, "accessors[0].byteOffset is -4");
  set("/accessors/0/bufferView", -1, "accessors[0].bufferView is -1");
  set("/accessors/0/componentType", 5124, "accessors[0].componentType is 5124");
  set("/accessors/0/type", "VEC5", "accessors[0].type is \"VEC5\"");
  set("/accessors/0/count", 0, "accessors[0].count is 0");
  set("/accessors/0/normalized", 1, "accessors[0].normalized is 1");
  set("/meshes/0/primitives/0/indices", -5, "meshes[0].primitives[0].indices is -5");
  set("/meshes/0/primitives/0/indices", "0", "meshes[0].primitives[0].indices is \"0\"");
  set("/meshes/0/primitives/0/mode", 7, "meshes[0].primitives[0].mode is 7");
  set("/meshes/0/primitives/0/attributes/NORMAL", -1, "meshes[0].primitives[0].attributes.NORMAL is -1");
  set("/meshes/0/primitives", json::object(), "meshes[0].primitives is an object");
  set("/materials/0/pbrMetallicRoughness/baseColorFactor", {1, 1},
      "materials[0].pbrMetallicRoughness.baseColorFactor is an array of 2");
  set("/materials/0/pbrMetallicRoughness/baseColorFactor", {1, 1, "1", 1}, "baseColorFactor[2] is \"1\"");
  set("/materials/0/pbrMetallicRoughness/baseColorFactor", {1.1, 1, 1, 1}, "baseColorFactor[0] is 1.1");
  set("/materials/0/pbrMetallicRoughness/baseColorTexture", {{"index", -1}}, "baseColorTexture.index is -1");
  set("/materials/0/pbrMetallicRoughness", 3, "materials[0].pbrMetallicRoughness is 3");
  set("/materials/0/doubleSided", "yes", "materials[0].doubleSided is \"yes\"");
  set("/materials/0/alphaMode", 2, "materials[0].alphaMode is 2");
  set("/materials/0/extensions/KHR_materials_transmission", {{"transmissionFactor", "1"}},
      "transmissionFactor is \"1\"");
  set("/materials", json::object(), "materials is an object");
  set("/nodes/0/translation", {1, 2}, "nodes[0].translation is an array of 2");
  set("/nodes/0/rotation", {0, 0, 0, 2}, "nodes[0].rotation[3] is 2");
  set("/nodes/0/scale", "2", "nodes[0].scale is \"2\"");
  set("/nodes/0/matrix", std::vector<int>(15, 1), "nodes[0].matrix is an array of 15");
  set("/nodes/0/matrix", std::vector<int>(16, 1), "nodes[0].matrix is an array of 16");
  set("/nodes/0/mesh", 0.5, "nodes[0].mesh is 0.5");
  set("/nodes/0/children", 3, "nodes[0].children is 3");
  set("/nodes/0/skin", 0, "nodes[0].skin is 0");
  set("/scene", -1, "scene is -1");
  set("/extensionsRequired", "KHR_x", "extensionsRequired is \"KHR_x\"");
  refuses(
      [](GltfFile& f) {
        f.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        f.root["nodes"][0]["scale"] = {1, 1, 1};
      },
      "nodes[0] has both a matrix and a scale");
  // A texture's transform is checked as a whole, too.
  refuses(
      [&](GltfFile& f) {
        set_picture(f, picture());
        f.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
            {"scale", {2}}};
      },
      "KHR_texture_transform.scale is an array of 1");
  refuses(
      [](GltfFile& f) {
        primitive(f)["attributes"]["COLOR_0"] =
            f.accessor<std::uint8_t>(std::vector<std::uint8_t>(9, 255), 5121, "VEC3", 3);
      },
      "COLOR_0 has integers that are not normalized");
  EXPECT_NE(read_bytes("[1, 2]").ok(), true);
}

TEST_F(SceneGltf, RoundedFactorsAreClamped) {
  GltfFile file = triangle();
  file.root["materials"][0] = {
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {1.0000001192092896, -1e-8, 0.5, 1}}, {"roughnessFactor", 1.0000001}}}};
  const MeshData data = load(file);
  ASSERT_FALSE(data.materials.empty());
  EXPECT_EQ(data.materials[0].color, glm::vec4(1.0F, 0.0F, 0.5F, 1.0F));
  EXPECT_EQ(data.materials[0].roughness, 1.0F);
}

TEST_F(SceneGltf, NumbersThatAreNotFiniteAreRefusedByName) {
  for (const auto& [name, components] :
       {std::pair("NORMAL", 3), std::pair("TEXCOORD_0", 2), std::pair("COLOR_0", 3), std::pair("COLOR_0", 4)}) {
    for (const float bad : {kNaN, std::numeric_limits<float>::infinity()}) {
      refuses(
          [&, key = name, size = components](GltfFile& f) {
            std::vector<float> values(3 * static_cast<std::size_t>(size), 0.5F);
            values.back() = bad;
            primitive(f)["attributes"][key] = f.floats(values, size);
          },
          "meshes[0].primitives[0].attributes." + std::string(name) +
              " (accessors[1]) has an element that is not finite, number 2");
    }
  }
  GltfFile file = triangle();
  primitive(file)["attributes"]["COLOR_0"] = file.floats({2, 0, 0, 1, 0, 0, 1, 0, 0}, 3);
  const MeshData data = load(file);
  EXPECT_EQ(data.vertices[0].color, (MeshColor{0xFFFF, 0, 0, 0xFFFF}));
  expect_note(data, "COLOR_0 has values outside 0 to 1");
}

TEST_F(SceneGltf, ATextureWithoutItsCoordinatesIsLeftOutWithANote) {
  GltfFile file = triangle();
  set_picture(file, picture());
  file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1;
  file.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.5, 0.5, 1};
  primitive(file)["attributes"]["TEXCOORD_0"] = file.floats({0, 0, 1, 0, 0, 1}, 2);
  const MeshData without = load(file);
  ASSERT_EQ(without.parts.size(), 1U);
  EXPECT_EQ(without.materials[without.parts[0].material].texture, -1);
  EXPECT_EQ(without.materials[without.parts[0].material].color.x, 0.5F);
  expect_note(without, "meshes[0].primitives[0] has no TEXCOORD_1, which materials[0] names");
  GltfFile many = file;
  for (int i = 0; i < 3; ++i) many.root["meshes"][0]["primitives"].push_back(primitive(file));
  const MeshData repeated = load(many);
  EXPECT_EQ(repeated.notes.size(), 1U);
  expect_note(repeated, "(and 3 more of this kind)");
  primitive(file)["attributes"]["TEXCOORD_1"] = file.floats({0.5, 0, 1, 0, 0, 1}, 2);
  const MeshData with = load(file);
  EXPECT_EQ(with.materials[with.parts[0].material].texture, 0);
  EXPECT_EQ(with.vertices[0].uv, glm::vec2(0.5F, 0.0F));
  EXPECT_TRUE(with.notes.empty());
}

TEST_F(SceneGltf, AccessorsWithoutDataAreZerosAndSparseOnesAreRead) {
  GltfFile file = triangle();
  const std::vector<std::uint16_t> where = {1, 2};
  const int index_view = file.view(where.data(), where.size() * sizeof(std::uint16_t));
  const std::vector<float> values = {5, 0, 0, 0, 5, 0};
  const int value_view = file.view(values.data(), values.size() * sizeof(float));
  const json sparse = {{"count", 2},
                       {"indices", {{"bufferView", index_view}, {"componentType", 5123}}},
                       {"values", {{"bufferView", value_view}}}};
  // Sparse values replace corners, or zeros if the accessor has no view.
  for (const bool zeros : {false, true}) {
    file.root["accessors"][0]["sparse"] = sparse;
    if (zeros) file.root["accessors"][0].erase("bufferView");
    EXPECT_EQ(positions(load(file)), (std::vector<glm::vec3>{{0, 0, 0}, {5, 0, 0}, {0, 5, 0}}));
  }
  file.root["accessors"][0]["sparse"]["count"] = 4;
  refuses_bytes(file.text(), "accessors[0].sparse.count is 4");
  file.root["accessors"][0]["sparse"] = sparse;
  file.root["accessors"][0]["sparse"]["values"]["byteOffset"] = 8;
  refuses_bytes(file.text(), "accessors[0].sparse.values of 2 elements ends at byte 32");
  file.root["accessors"][0]["sparse"] = sparse;
  file.bytes[37] = 9;  // the first index
  refuses_bytes(file.text(), "has the sparse index 2305");
  // Colours without data are black.
  GltfFile black = triangle();
  black.root["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
  primitive(black)["attributes"]["COLOR_0"] = 1;
  EXPECT_EQ(load(black).vertices[0].color, (MeshColor{0, 0, 0, 0xFFFF}));
}

TEST_F(SceneGltf, ExtensionsAreRefusedOrNotedByName) {
  refuses([](GltfFile& f) { f.root["extensionsRequired"] = {"KHR_texture_basisu"}; },
          "requires the extension KHR_texture_basisu");
  refuses([](GltfFile& f) { f.root["extensionsRequired"] = {"KHR_materials_unlit"}; },
          "requires the extension KHR_materials_unlit");
  GltfFile file = triangle();
  file.root["extensionsUsed"] = {"KHR_materials_unlit", "KHR_texture_transform", "KHR_lights_punctual",
                                 "KHR_materials_unlit"};
  file.root["materials"][0]["emissiveFactor"] = {1, 0, 0};
  file.root["animations"] = json::array({json::object()});
  const MeshData data = load(file);
  expect_note(data, "not supported are ignored: KHR_lights_punctual, KHR_materials_unlit");
  expect_note(data, "animations");
  expect_note(data, "emission");
  // The image of the texture is defined only by an extension.
  set_picture(file, picture());
  file.root["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
  expect_note(load(file), "textures[0] has no PNG or JPEG picture");
}

TEST_F(SceneGltf, SkinsAreDrawnInThePoseOfTheirJoints) {
  GltfFile file = triangle();
  primitive(file)["attributes"]["JOINTS_0"] =
      file.accessor<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 5121, "VEC4", 4);
  primitive(file)["attributes"]["WEIGHTS_0"] = file.floats({1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0}, 4);
  primitive(file)["attributes"]["NORMAL"] = file.points({{0, 0, 1}, {0, 0, 1}, {0, 1, 0}});
  // The second joint is a child of the first, at (1, 0, 0) in the bind pose; here it is rotated by 90 degrees about z.
  const int child =
      file.node({{"translation", {1, 0, 0}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}}, false);
  const int root = file.node({{"translation", {0, 0, 3}}, {"children", {child}}});
  const int inverse = file.accessor<float>(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}, 5126, "MAT4",
      16);
  file.root["skins"] = {{{"joints", {root, child}}, {"inverseBindMatrices", inverse}}};
  file.root["nodes"][0]["skin"] = 0;
  file.root["nodes"][0]["translation"] = {100, 0, 0};  // ignored
  const MeshData data = load(file);
  const std::vector<glm::vec3> p = positions(data);
  ASSERT_EQ(p.size(), 3U);
  // (0, 1, 0) relative to the second joint is (-1, 1, 0), rotated to (-1, -1, 0): (0, -1, 3). The other half of its
  // weight gives (0, 1, 3).
  const std::vector<glm::vec3> expected = {{0, 0, 3}, {1, 0, 3}, {0, 0, 3}};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(glm::distance(p[i], expected[i]), 1e-5F) << i;
  EXPECT_LT(glm::distance(data.vertices[2].normal, glm::normalize(glm::vec3(-1, 1, 0))), 1e-5F);
  expect_note(data, "skins are drawn in the pose");
  primitive(file)["attributes"].erase("WEIGHTS_0");
  refuses_bytes(file.text(), "only one of JOINTS_0 and WEIGHTS_0");
  file.root["skins"][0]["joints"] = {root};
  GltfFile few = file;
  primitive(few)["attributes"]["WEIGHTS_0"] = few.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0}, 4);
  refuses_bytes(few.text(), "has joint 1 at vertex 1");
}

std::string chunk(const std::string& kind, const std::string& body) {
  const auto word = [](std::size_t value) {
    return std::string{static_cast<char>(value >> 24U), static_cast<char>(value >> 16U), static_cast<char>(value >> 8U),
                       static_cast<char>(value)};
  };
  const std::string text = kind + body;
  return word(body.size()) + text +
         word(crc32(0, reinterpret_cast<const unsigned char*>(text.data()), static_cast<unsigned>(text.size())));
}

// Returns a square PNG of 8-bit grey whose picture data inflate to `size` zeros.
std::string grey_png(std::uint32_t side, std::size_t size, bool interlaced = false) {
  std::vector<unsigned char> zeros(size), packed(compressBound(size));
  uLongf length = packed.size();
  compress(packed.data(), &length, zeros.data(), size);
  const std::string word = {0, 0, static_cast<char>(side >> 8U), static_cast<char>(side)};
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", word + word + std::string("\x08\0\0\0", 4) + std::string(1, interlaced ? '\1' : '\0')) +
         chunk("IDAT", std::string(reinterpret_cast<char*>(packed.data()), length)) + chunk("IEND", "");
}

long peak_kib() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST_F(SceneGltf, DamagedPicturesAreRefusedBeforeTheyCostMemory) {
  const auto with = [&](const std::string& bytes) { return [&](GltfFile& f) { set_picture(f, bytes); }; };
  // A picture of 2x2, and the same with too few and too many picture data.
  GltfFile fine = triangle();
  set_picture(fine, grey_png(2, 6));
  EXPECT_EQ(load(fine).textures.size(), 1U);
  GltfFile interlaced = triangle();
  set_picture(interlaced, grey_png(8, 79, true));  // the bytes of the seven passes with their filters
  EXPECT_EQ(load(interlaced).textures.size(), 1U);
  const long before = peak_kib();
  refuses(with(grey_png(2, 5)), "images[0] is a picture whose picture data is damaged");
  refuses(with(grey_png(2, 60'000'000)), "images[0] is a picture whose picture data is damaged");
  refuses(with(grey_png(8000, 1000)), "images[0] is a picture whose picture data is damaged");
  std::string claims = grey_png(2, 6);
  claims[33] = 0x7F;  // the length of IDAT
  refuses(with(claims), "has a chunk of 2130706");
  const long limit = kSanitizers ? 600'000 : 150'000;  // the test itself needs 60 MB for the zeros
  EXPECT_LT(peak_kib() - before, limit);
  std::string changed = grey_png(2, 6);
  changed[43] = static_cast<char>(changed[43] ^ 1);
  refuses(with(changed), "images[0] is a picture whose checksums are wrong");
  refuses(with(grey_png(2, 6).substr(0, 60)), "images[0] is a picture which");
  refuses(
      [&](GltfFile& f) {
        set_picture(f, picture());
        f.root["bufferViews"].back()["byteOffset"] = 1000;
      },
      "bufferViews[1] ends at byte ");
}

// The decoder silently fills the rest of a truncated JPEG with grey.
TEST_F(SceneGltf, JpegsThatEndEarlyAreRefused) {
  std::string jpeg;
  const std::vector<unsigned char> red(std::size_t{3} * 64 * 64, 200);
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<char*>(data), static_cast<std::size_t>(size));
  };
  ASSERT_NE(stbi_write_jpg_to_func(append, &jpeg, 64, 64, 3, red.data(), 90), 0);
  GltfFile file = triangle();
  set_picture(file, jpeg + "something behind it");
  const MeshData data = load(file);
  ASSERT_EQ(data.textures.size(), 1U);
  EXPECT_NEAR(data.textures[0].rgba[0], 200, 2);
  refuses([&](GltfFile& f) { set_picture(f, jpeg.substr(0, jpeg.size() - 20)); },
          "images[0] is a picture which ends early");
  // A header that claims 8000x8000 texels: height and width follow the marker FF C0, a length and a depth.
  const std::size_t frame = jpeg.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  std::string claims = jpeg;
  claims[frame + 5] = claims[frame + 7] = 0x1F;
  refuses([&](GltfFile& f) { set_picture(f, claims); }, "images[0] is a picture which ends early");
}

}  // namespace
}  // namespace tyndall::scene
