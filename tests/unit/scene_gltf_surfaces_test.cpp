// The surfaces of glTF files: which alpha they use, vertex colours, and the front of mirrored skins.
#include <cmath>

#include "scene/mesh/mesh_textures.hpp"
#include "scene_gltf.hpp"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace tyndall::scene {
namespace {

// A PNG of two texels, red and blue, with these values of alpha.
std::string red_and_blue(unsigned char red_alpha, unsigned char blue_alpha) {
  const std::vector<unsigned char> texels = {255, 0, 0, red_alpha, 0, 0, 255, blue_alpha};
  std::string png;
  const auto append = [](void* out, void* data, int size) {
    static_cast<std::string*>(out)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  };
  EXPECT_NE(stbi_write_png_to_func(append, &png, 2, 1, 4, texels.data(), 8), 0);
  return png;
}

class SceneGltfSurfaces : public SceneGltf {
 protected:
  static GltfFile textured(const std::string& png, const json& material) {
    GltfFile file = triangle();
    file.root["materials"][0].update(material);
    set_picture(file, png);
    primitive(file)["attributes"]["TEXCOORD_0"] = file.floats({0, 0, 1, 0, 0, 1}, 2);
    return file;
  }
};

// The mean of both texels. Weighted by alpha, it would be red only.
TEST_F(SceneGltfSurfaces, OpaqueMaterialsIgnoreTheAlphaOfTheirTextures) {
  for (const json& material : {json::object(), json{{"alphaMode", "MASK"}, {"alphaCutoff", 0}}}) {
    const MeshData data = load(textured(red_and_blue(255, 0), material));
    ASSERT_EQ(data.textures.size(), 1U);
    EXPECT_EQ(data.textures[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 0, 255, 255}));
    const std::vector<MeshTexture> smaller = mip_levels(data.textures[0]);
    ASSERT_EQ(smaller.size(), 1U);
    EXPECT_EQ(smaller[0].rgba, (std::vector<std::uint8_t>{188, 0, 188, 255}));
  }
  // With holes, the texels in them do not count.
  const MeshData holes = load(textured(red_and_blue(255, 0), {{"alphaMode", "MASK"}}));
  EXPECT_EQ(mip_levels(holes.textures[0])[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 128}));
}

// The header of a JPEG picture of one pixel with four components, whose colours only a segment of Adobe defines.
TEST_F(SceneGltfSurfaces, JpegsOfUndeclaredColoursAreRefused) {
  const std::string frame("\xFF\xC0\x00\x14\x08\x00\x01\x00\x01\x04\x01\x11\x00\x02\x11\x00\x03\x11\x00\x04\x11\x00",
                          22);
  const std::string adobe("\xFF\xEE\x00\x0E"
                          "Adobe\x00\x64\x00\x00\x00\x00\x02",
                          16);
  const std::string scan("\xFF\xDA\x00\x02\xFF\xD9", 6);
  refuses_bytes(textured("\xFF\xD8" + frame + scan, json::object()).text(), "four components without Adobe's segment");
  refuses_bytes(textured("\xFF\xD8" + adobe + frame + scan, json::object()).text(), "that is damaged");
}

TEST_F(SceneGltfSurfaces, ScenesAfterTheFirstAreNotedWithoutADefault) {
  GltfFile file = triangle();
  file.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {0}}}};
  file.root.erase("scene");
  expect_note(load(file), "scenes after the first");
  file.root["scene"] = 1;
  EXPECT_EQ(load(file).notes.size(), load(triangle()).notes.size());
}

// One picture is stored twice only if it has alpha and its materials differ in their use of it.
TEST_F(SceneGltfSurfaces, PicturesAreStoredOnceForEachUse) {
  for (const unsigned char alpha : {255, 254}) {
    GltfFile file = textured(red_and_blue(255, alpha), json::object());
    json mask = file.root["materials"][0];
    mask["alphaMode"] = "MASK";
    file.root["materials"].push_back(mask);
    file.root["materials"].push_back(file.root["materials"][0]);
    const MeshData data = load(file);
    EXPECT_EQ(data.textures.size(), alpha == 255 ? 1U : 2U);
    EXPECT_EQ(data.materials[0].texture, data.materials[2].texture);
    EXPECT_EQ(data.materials[0].texture == data.materials[1].texture, alpha == 255);
  }
}

TEST_F(SceneGltfSurfaces, BlendWithoutTransparencyIsOpaque) {
  const json blend = {{"alphaMode", "BLEND"}};
  const auto kind = [&](const GltfFile& file) { return load(file).materials[0].kind; };
  EXPECT_EQ(kind(textured(red_and_blue(255, 255), blend)), SurfaceKind::opaque);
  EXPECT_EQ(kind(textured(red_and_blue(255, 254), blend)), SurfaceKind::blend);
  GltfFile factor = triangle();
  factor.root["materials"][0].update(blend);
  EXPECT_EQ(kind(factor), SurfaceKind::opaque);
  GltfFile vertices = factor;
  primitive(vertices)["attributes"]["COLOR_0"] = vertices.floats(std::vector<float>(12, 0.5F), 4);
  EXPECT_EQ(kind(vertices), SurfaceKind::blend);
  factor.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.9};
  EXPECT_EQ(kind(factor), SurfaceKind::blend);
}

TEST_F(SceneGltfSurfaces, GlassMayHaveHoles) {
  json material = {{"alphaMode", "MASK"},
                   {"alphaCutoff", 0.25},
                   {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}}}};
  GltfFile file = triangle();
  file.root["materials"][0].update(material);
  const MeshData holes = load(file);
  EXPECT_EQ(holes.materials[0].kind, SurfaceKind::glass);
  EXPECT_EQ(holes.materials[0].alpha_cutoff, 0.25F);
  file.root["materials"][0]["alphaMode"] = "BLEND";
  const MeshData blend = load(file);
  EXPECT_EQ(blend.materials[0].alpha_cutoff, 0.0F);
  expect_note(blend, "alpha of materials with transmission");
}

TEST_F(SceneGltfSurfaces, DarkVertexColoursAreAccurate) {
  GltfFile file = triangle();
  const std::vector<float> dark = {0.002F, 0.001F, 0.0029F};
  std::vector<float> colors;
  for (int i = 0; i < 3; ++i) colors.insert(colors.end(), dark.begin(), dark.end());
  primitive(file)["attributes"]["COLOR_0"] = file.floats(colors, 3);
  const MeshColor color = load(file).vertices[0].color;
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(color[c] / 65535.0, dark[c], 1e-5) << c;
  EXPECT_EQ(color[3], 0xFFFF);
}

// A node that mirrors both the mesh and its joints, as exporters write it for the other half of a body.
TEST_F(SceneGltfSurfaces, MirroredSkinsShowTheirFront) {
  GltfFile file = triangle();
  primitive(file)["attributes"]["JOINTS_0"] =
      file.accessor<std::uint8_t>(std::vector<std::uint8_t>(12), 5121, "VEC4", 4);
  primitive(file)["attributes"]["WEIGHTS_0"] = file.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4);
  const int joint = file.node(json::object(), false);
  file.root["skins"] = {{{"joints", {joint}}}};
  file.root["nodes"][0]["skin"] = 0;
  const int root = file.node({{"scale", {-1, 1, 1}}, {"children", {0, joint}}});
  file.root["scenes"][0]["nodes"] = {root};
  for (const bool given : {false, true}) {
    if (given) primitive(file)["attributes"]["NORMAL"] = file.points({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
    const MeshData data = load(file);
    const std::vector<glm::vec3> p = positions(data);
    ASSERT_EQ(p.size(), 3U);
    EXPECT_LT(glm::distance(p[0] + p[1] + p[2], glm::vec3(-1, 1, 0)), 1e-6F);
    EXPECT_LT(glm::distance(glm::cross(p[1] - p[0], p[2] - p[0]), glm::vec3(0, 0, 1)), 1e-6F);  // the front faces +z
    for (const std::uint32_t i : data.indices)
      EXPECT_LT(glm::distance(data.vertices[i].normal, glm::vec3(0, 0, 1)), 1e-6F) << given;
  }
}

}  // namespace
}  // namespace tyndall::scene
