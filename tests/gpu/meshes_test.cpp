// Meshes on a device: their positions, holes and shadows, and the colour of light transmitted by glass, on surfaces and
// in the medium.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "config/scene_file.hpp"
#include "gpu_test.hpp"
#include "image/metrics.hpp"
#include "mesh_files.hpp"
#include "scene/mesh/mesh_textures.hpp"
#include "shared_scene.hpp"

namespace tyndall::scene {
namespace {

constexpr VkExtent2D kExtent = {96, 54};
constexpr double kHeight_m = 20.0;  // height of the camera, which looks straight down; north is up in the picture

class GpuMeshes : public SharedSceneTest {
 protected:
  GpuMeshes()
      : path_((std::filesystem::temp_directory_path() / ("tyndall-meshes-" + std::to_string(::getpid()) + "-.glb"))
                  .string()) {
    params_.tables.size = {8, 32, 32, 4};
    params_.tables.orders = 1;
    params_.scattering.enabled = false;  // only surfaces
    scene_.terrain.source = "none";
    scene_.camera.position_m = {0.0F, static_cast<float>(kHeight_m), 0.0F};
    scene_.camera.yaw_deg = 0.0F;
    scene_.camera.pitch_deg = -90.0F;
    scene_.camera.fov_deg = 45.0F;
    scene_.sun.elevation_deg = 60.0F;
    scene_.sun.azimuth_deg = 90.0F;
    scene_.shadows.distance_m = 60.0F;
    scene_.shadows.cascades = 2;
    scene_.shadows.first_marched = 0;
    white_ = file_.material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.6, 0.6, 0.6, 1}}}}});
  }
  void TearDown() override {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    GpuTest::TearDown();
  }

  int glass(double r, double g, double b, double roughness) {
    return file_.material(
        {{"pbrMetallicRoughness", {{"baseColorFactor", {r, g, b, 1}}, {"roughnessFactor", roughness}}},
         {"doubleSided", true},
         {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}}}}});
  }

  std::unique_ptr<Scene> make(bool with_file = true, VkExtent2D extent = kExtent, bool timings = false) {
    SceneDesc desc;
    desc.extent = extent;
    desc.timings = timings;
    scene_.meshes.source = with_file ? file_.save(path_) : "none";
    Result<std::unique_ptr<Scene>> scene = Scene::create(host(), desc, params_, scene_);
    EXPECT_OK(scene);
    return scene.ok() ? std::move(scene).value() : nullptr;
  }
  image::Image draw(bool with_file = true) {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    static int files = 0;
    // A scene reads a file with the same name only once, so each drawing has a new name.
    path_ = path_.substr(0, path_.rfind('-') + 1) + std::to_string(files++) + ".glb";
    scene_.meshes.source = with_file ? file_.save(path_) : "none";
    Scene* const scene = shared_scene(kExtent, params_, scene_);
    return scene != nullptr ? draw(*scene) : image::Image(kExtent.width, kExtent.height);
  }
  static image::Image draw(Scene& scene) {
    EXPECT_OK(scene.render(0.0));
    Result<image::Image> radiance = scene.radiance();
    EXPECT_OK(radiance);
    for (const float value : radiance.value().rgb) EXPECT_TRUE(std::isfinite(value) && value >= 0.0F);
    return std::move(radiance).value();
  }
  // Returns the radiance of a point at a height `y` above the ground, seen from above.
  static glm::dvec3 at(const image::Image& image, double x, double z, double y = 0.0) {
    const double px_per_m = 0.5 * kExtent.height / (std::tan(0.5 * 0.785398163) * (kHeight_m - y));
    const auto i = static_cast<std::size_t>(0.5 * kExtent.width + x * px_per_m);
    const auto j = static_cast<std::size_t>(0.5 * kExtent.height + z * px_per_m);
    const float* const p = &image.rgb[3 * (j * kExtent.width + i)];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
  }
  static void expect_near(const glm::dvec3& a, const glm::dvec3& b, double share, const char* what) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], share * b[c] + 1e-9) << what << " channel " << c;
  }

  GltfFile file_;
  int white_ = 0;
  Params params_;
  SceneParams scene_;

  std::string path_;
};

TEST_F(GpuMeshes, ALevelFaceIsLitLikeTheGroundAndOnlyItsFrontIsSeen) {
  file_.level_quad(-6, -2, -2, 2, 0.5F, white_);
  file_.quad({2, 0.5F, -2}, {6, 0.5F, -2}, {6, 0.5F, 2}, {2, 0.5F, 2}, white_);  // faces down
  const int mirrored = file_.level_quad(8, -2, 12, 2, 0.5F, white_);
  file_.root["nodes"][static_cast<std::size_t>(mirrored)]["scale"] = {-1, 1, 1};  // at x -12 to -8, still facing up
  const image::Image image = draw();
  const glm::dvec3 ground = at(image, 0.0, 6.0);
  for (int c = 0; c < 3; ++c) EXPECT_GT(ground[c], 0.0);
  // Face and ground are level and have the same sun and sky. Only their albedos differ: 0.6 and 0.3.
  expect_near(at(image, -4.0, 0.0, 0.5), 2.0 * ground, 0.002, "face");
  expect_near(at(image, -10.0, 0.0, 0.5), 2.0 * ground, 0.002, "mirrored face");
  EXPECT_LT(at(image, 4.0, 0.0, 0.5).x, 0.5 * ground.x);  // only its shadow on the ground is visible
  // The face covers the expected number of pixels.
  const double px_per_m = 0.5 * kExtent.height / (std::tan(0.5 * 0.785398163) * (kHeight_m - 0.5));
  std::size_t bright = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) bright += image.rgb[i] > 1.5 * ground.x ? 1 : 0;
  EXPECT_NEAR(static_cast<double>(bright), 2.0 * 16.0 * px_per_m * px_per_m, 0.15 * 32.0 * px_per_m * px_per_m);
}

// The floor of a model at y = 0 is in the plane of the bare ground and hides it, from near and far and at grazing
// angles.
TEST_F(GpuMeshes, AFloorAtSeaLevelHidesTheBareGround) {
  struct Shot {
    View view;
    image::Image image;
  };
  const std::unique_ptr<Scene> scene = make(false);
  ASSERT_NE(scene, nullptr);
  const auto shots = [&](const std::string& meshes) {
    scene_.meshes.source = meshes;
    std::vector<Shot> out;
    for (const float height_m : {0.6F, 1.7F, 40.0F, 700.0F, 9000.0F}) {
      for (const float pitch_deg : {-90.0F, -35.0F, -4.0F}) {
        for (const float x_m : {0.013F, 7.7F}) {
          scene_.camera.position_m = {x_m, height_m, 0.3F * x_m};
          scene_.camera.yaw_deg = 30.0F * x_m;
          scene_.camera.pitch_deg = pitch_deg;
          EXPECT_OK(scene->set_scene(scene_));
          image::Image image = draw(*scene);
          out.push_back({scene->images().view, std::move(image)});
        }
      }
    }
    return out;
  };
  const std::vector<Shot> bare = shots("none");
  file_.level_quad(-1, -1, 1, 1, 0.0F, file_.material({{"name", "white"}}));
  const std::string source = file_.save(path_);
  for (const float size_m : {15.0F, 1000.0F}) {
    scene_.meshes.scale = size_m;
    const std::vector<Shot> floors = shots(source);
    std::size_t checked = 0;
    std::size_t ground = 0;
    for (std::size_t k = 0; k < floors.size(); ++k) {
      const View& view = floors[k].view;
      for (std::uint32_t j = 0; j < kExtent.height; ++j) {
        for (std::uint32_t i = 0; i < kExtent.width; ++i) {
          const double x = (2.0 * (i + 0.5) / kExtent.width - 1.0) * view.tan_half_width;
          const double y = (1.0 - 2.0 * (j + 0.5) / kExtent.height) * view.tan_half_height;
          const glm::dvec3 ray = view.forward + view.right * x + view.up * y;
          if (ray.y >= 0.0) continue;
          const glm::dvec3 hit = view.position - ray * (view.position.y / ray.y);
          if (std::max(std::abs(hit.x), std::abs(hit.z)) > 0.95 * static_cast<double>(size_m)) continue;
          ++checked;
          // The floor's albedo is 1, the ground's 0.3.
          const std::size_t pixel = 3 * (j * kExtent.width + i);
          if (floors[k].image.rgb[pixel] < 2.0F * bare[k].image.rgb[pixel]) ++ground;
        }
      }
    }
    EXPECT_GT(checked, 10000U) << size_m;
    EXPECT_EQ(ground, 0U) << "of " << checked << " pixels of a floor of " << size_m << " m";
  }
}

TEST_F(GpuMeshes, HolesPassLightAndShowWhatIsBehind) {
  // The western half is a hole.
  {
    // src/image cannot write alpha, so the vertices have it instead.
    const int position =
        file_.points({{-4, 3, 3}, {0, 3, 3}, {0, 3, -3}, {-4, 3, -3}, {0, 3, 3}, {4, 3, 3}, {4, 3, -3}, {0, 3, -3}});
    const int color = file_.floats({1, 1, 1, 0.2F, 1, 1, 1, 0.2F, 1, 1, 1, 0.2F, 1, 1, 1, 0.2F,
                                    1, 1, 1, 0.9F, 1, 1, 1, 0.9F, 1, 1, 1, 0.9F, 1, 1, 1, 0.9F},
                                   4);
    const int indices = file_.accessor<std::uint16_t>({0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}, 5123, "SCALAR", 1);
    const int mask = file_.material({{"alphaMode", "MASK"}, {"doubleSided", true}});
    file_.node({{"mesh", file_.mesh({{"attributes", {{"POSITION", position}, {"COLOR_0", color}}},
                                     {"indices", indices},
                                     {"material", mask}})}});
  }
  const image::Image with = draw();
  const image::Image without = draw(false);
  const glm::dvec3 open = at(without, -8.0, 5.0);
  expect_near(at(with, -2.0, 0.0, 3.0), at(without, -2.0, 0.0, 3.0), 0.002, "through the hole");
  EXPECT_GT(at(with, 2.0, 0.0, 3.0).x, 2.5 * open.x);  // white
  // The sun is in the east at 60 degrees, so shadows are displaced by 3 / tan(60) = 1.7 m to the west. The hole casts
  // none.
  expect_near(at(with, -5.0, 0.0), at(without, -5.0, 0.0), 0.002, "light through the hole");
  EXPECT_LT(at(with, -1.2, 0.0).x, 0.5 * open.x);  // below the hole, in the shadow of the other half
}

TEST_F(GpuMeshes, GlassColoursOnlyWhatIsBehindIt) {
  const int clear = glass(1.0, 0.1, 0.5, 0.0);
  file_.level_quad(-8, -4, -2, 4, 3.0F, clear);
  file_.level_quad(-6, -1, -4, 1, 4.0F, white_);  // between the glass and the sun
  // For comparison, a face at the same height and its shadow, without glass.
  file_.level_quad(4, -1, 6, 1, 4.0F, white_);
  file_.level_quad(4, 3, 6, 5, 4.0F,
                   file_.material({{"alphaMode", "BLEND"},
                                   {"pbrMetallicRoughness", {{"baseColorFactor", {0.6, 0.6, 0.6, 0.9999}}}}}));
  scene_.sun.elevation_deg = 30.0F;
  const image::Image image = draw();
  const glm::dvec3 open = at(image, 0.0, 7.0);
  const glm::dvec3 dark = at(image, 5.0 - 4.0 / std::tan(0.523598776), 0.0);
  ASSERT_LT(dark.x, 0.6 * open.x);
  // The ground in the shadow of the glass (x -13.2 to -7.2) that is not seen through the glass (x below -9.4): sunlight
  // is multiplied by the colour of the glass.
  const glm::dvec3 colored = at(image, -11.0, 2.5);
  const glm::dvec3 expected = dark + (open - dark) * glm::dvec3(1.0, 0.1, 0.5);
  expect_near(colored, expected, 0.03, "ground behind glass");
  // Surfaces seen through clear glass are multiplied by its colour once more. The light of the sky is not coloured.
  const glm::dvec3 seen = at(image, -3.0, 3.0, 3.0);
  EXPECT_LT(seen.y, 0.2 * seen.x);
  // Surfaces in front of the glass do not change.
  expect_near(at(image, -5.0, 0.0, 4.0), at(image, 5.0, 0.0, 4.0), 0.002, "before the glass");
  expect_near(at(image, 5.0, 4.0, 4.0), at(image, 5.0, 0.0, 4.0), 0.002,
              "a surface that is glass and hardly transparent");
}

TEST_F(GpuMeshes, DiffusingGlassGlowsAndHidesWhatIsBehind) {
  file_.level_quad(-3, -3, 3, 3, 3.0F, glass(0.2, 0.9, 0.2, 1.0));
  file_.level_quad(-1, -1, 1, 1, 9.0F, white_);  // behind it, and not in front of the middle of the sun
  scene_.camera.position_m = {0.0F, 1.0F, 0.0F};
  scene_.camera.pitch_deg = 90.0F;
  const image::Image image = draw();
  const float* const p = &image.rgb[3 * (kExtent.height / 2 * kExtent.width + kExtent.width / 2)];
  EXPECT_GT(p[1], 0.1F);
  EXPECT_NEAR(p[0] / p[1], 0.2 / 0.9, 0.03);
}

TEST_F(GpuMeshes, ColourMapsExistOnlyWithGlass) {
  file_.level_quad(-2, -2, 2, 2, 0.5F, white_);
  std::unique_ptr<Scene> plain = make(true, kExtent, true);
  ASSERT_NE(plain, nullptr);
  draw(*plain);
  const auto colors = [](const Scene& scene) {
    return std::count_if(scene.timings().begin(), scene.timings().end(),
                         [](const PassTime& p) { return p.name == "shadow_colors"; });
  };
  EXPECT_EQ(colors(*plain), 0);
  const VkDeviceSize before = plain->memory().scene;
  file_.level_quad(4, -2, 6, 2, 0.5F, glass(1, 0, 0, 1));
  const std::unique_ptr<Scene> with = make(true, kExtent, true);
  ASSERT_NE(with, nullptr);
  draw(*with);
  EXPECT_EQ(colors(*with), 1);
  EXPECT_GE(with->memory().scene, before + 8ULL * 1024 * 1024 * 2);
}

TEST_F(GpuMeshes, MeshesAreAddedAndRemovedAndOtherModelsRefuseThem) {
  const std::unique_ptr<Scene> scene = make(false);
  ASSERT_NE(scene, nullptr);
  const image::Image bare = draw(*scene);
  file_.level_quad(-2, -2, 2, 2, 0.5F, white_);
  SceneParams changed = scene_;
  changed.meshes.source =
      file_.save(std::filesystem::temp_directory_path() / ("tyndall-meshes-" + std::to_string(::getpid()) + ".glb"));
  ASSERT_OK(scene->set_scene(changed));
  EXPECT_NE(draw(*scene).rgb, bare.rgb);
  SceneParams wrong = changed;
  wrong.meshes.source = "/nonexistent.glb";
  EXPECT_FALSE(scene->set_scene(wrong).ok());
  wrong = changed;
  wrong.scattering.model = ScatteringModel::homogeneous;
  EXPECT_FALSE(scene->set_scene(wrong).ok());
  ASSERT_OK(scene->set_scene(scene_));
  EXPECT_EQ(draw(*scene).rgb, bare.rgb);
  // Yaw rotates clockwise seen from above, so east becomes south.
  changed.meshes.position_m = {0.0F, 0.0F, 0.0F};
  file_.level_quad(4, -1, 6, 1, 0.5F, white_);
  changed.meshes.source = file_.save(changed.meshes.source);
  changed.meshes.yaw_deg = 90.0F;
  ASSERT_OK(scene->set_scene(changed));
  const image::Image turned = draw(*scene);
  EXPECT_GT(at(turned, 0.0, 5.0, 0.5).x, 1.5 * at(turned, 5.0, 0.0, 0.5).x);
}

// The medium between the sun and a red pane is lit by white light, the medium behind it by red light.
TEST_F(GpuMeshes, MediumOnTheSunwardSideOfGlassIsNotColoured) {
  file_.level_quad(-40, -40, 40, 40, 10.0F, glass(1.0, 0.1, 0.1, 0.0));
  params_.scattering.enabled = true;
  params_.scattering.only = true;
  params_.scattering.medium = MediumKind::homogeneous;
  params_.homogeneous_medium.density = 300.0F;
  params_.homogeneous_medium.extent_m = 12.0F;  // rays end within the pane
  scene_.camera.pitch_deg = 0.0F;
  const std::unique_ptr<Scene> with = make(true);
  ASSERT_NE(with, nullptr);
  const std::unique_ptr<Scene> without = make(false);
  ASSERT_NE(without, nullptr);
  const std::string source = file_.save(path_);
  for (const Technique technique : {Technique::brute_force, Technique::epipolar}) {
    params_.scattering.technique = technique;
    for (const float y_m : {20.0F, 3.0F}) {
      const auto air = [&](Scene& scene, const std::string& meshes) {
        EXPECT_OK(scene.set_params(params_));
        scene_.camera.position_m.y = y_m;
        scene_.meshes.source = meshes;
        EXPECT_OK(scene.set_scene(scene_));
        const image::Image image = draw(scene);
        const float* const p = &image.rgb[3 * (kExtent.height / 3 * kExtent.width + kExtent.width / 2)];  // sky
        return glm::dvec3(p[0], p[1], p[2]);
      };
      const glm::dvec3 white = air(*without, "none");
      const glm::dvec3 color = y_m > 10.0F ? glm::dvec3(1.0) : glm::dvec3(1.0, 0.1, 0.1);
      ASSERT_GT(white.y, 0.0);
      expect_near(air(*with, source), color * white, 0.01, y_m > 10.0F ? "the sun's side" : "behind the pane");
    }
  }
}

// Compares pictures as by `tyndall render`, with the exposure of the scene.
TEST_F(GpuMeshes, ColouredShaftsOfTheHallAreThoseOfBruteForce) {
  config::Settings settings;
  ASSERT_OK(config::load(settings, TYNDALL_SOURCE_DIR "/scenes/hall.toml"));
  settings.scene.camera.samples = 1;
  settings.effect.tables.size = {8, 32, 32, 4};
  settings.effect.tables.orders = 1;
  settings.scene.shadows.resolution = 1024;
  constexpr VkExtent2D kPicture = {256, 144};
  std::vector<image::Image> pictures;
  for (const Technique technique : {Technique::brute_force, Technique::epipolar}) {
    Params params = settings.effect;
    params.scattering.technique = technique;
    Scene* const scene = shared_scene(kPicture, params, settings.scene);
    ASSERT_NE(scene, nullptr);
    draw(*scene);
    Result<image::Image> display = scene->display();
    ASSERT_OK(display);
    for (float& value : display.value().rgb) {
      const double x = static_cast<double>(value);
      const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
      value = static_cast<float>(std::round(255.0 * encoded) / 255.0);
    }
    pictures.push_back(std::move(display).value());
  }
  const image::Metrics metrics = image::compare(pictures[1], pictures[0]);
  RecordProperty("dB", std::to_string(metrics.psnr_db));
  EXPECT_GE(metrics.psnr_db, 40.0);
  // Some pixels of the in-scattering are strongly coloured.
  double saturation = 0.0;
  for (std::size_t i = 0; i < pictures[0].rgb.size(); i += 3) {
    const auto [low, high] = std::minmax({pictures[0].rgb[i], pictures[0].rgb[i + 1], pictures[0].rgb[i + 2]});
    saturation = std::max(saturation, static_cast<double>(high - low));
  }
  EXPECT_GT(saturation, 0.3);
}

// Meshes with glass that are added later give the same coloured in-scattering as those of a new scene.
TEST_F(GpuMeshes, GlassThatIsAddedLaterColoursInscattering) {
  config::Settings settings;
  ASSERT_OK(config::load(settings, TYNDALL_SOURCE_DIR "/scenes/hall.toml"));
  settings.scene.camera.samples = 1;
  settings.effect.tables.size = {8, 32, 32, 4};
  settings.effect.tables.orders = 1;
  settings.scene.shadows.resolution = 512;
  SceneDesc desc;
  desc.extent = {128, 72};
  SceneParams without = settings.scene;
  without.meshes.source = "none";
  Result<std::unique_ptr<Scene>> later = Scene::create(host(), desc, settings.effect, without);
  ASSERT_OK(later);
  draw(*later.value());
  ASSERT_OK(later.value()->set_scene(settings.scene));
  Result<std::unique_ptr<Scene>> at_once = Scene::create(host(), desc, settings.effect, settings.scene);
  ASSERT_OK(at_once);
  EXPECT_EQ(draw(*later.value()).rgb, draw(*at_once.value()).rgb);
}

// Texture coordinates on all faces go from 0 to 3. Three faces show the same red and blue picture with the wrap modes
// repeat, mirror and clamp, and nearest filtering. A fourth has linear filtering.
TEST_F(GpuMeshes, TexturesAreWrappedAndFilteredByTheirSamplers) {
  image::Image picture(2, 1);
  picture.rgb = {1, 0, 0, 0, 0, 1};
  const std::string png = path_ + ".png";
  ASSERT_OK(image::write_png(png, picture, {}));
  file_.root["images"] = {{{"uri", std::filesystem::path(png).filename().string()}}};
  const auto face = [&](float z, int wrap, int filter) {
    file_.root["samplers"].push_back({{"wrapS", wrap}, {"wrapT", wrap}, {"magFilter", filter}, {"minFilter", filter}});
    file_.root["textures"].push_back({{"source", 0}, {"sampler", file_.root["samplers"].size() - 1}});
    const int material = file_.material(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", file_.root["textures"].size() - 1}}}}}});
    const int position = file_.points({{-6, 0.5F, z + 1}, {6, 0.5F, z + 1}, {6, 0.5F, z - 1}, {-6, 0.5F, z - 1}});
    const int uv = file_.floats({0, 0, 3, 0, 3, 0, 0, 0}, 2);
    const int indices = file_.accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, 5123, "SCALAR", 1);
    file_.node({{"mesh", file_.mesh({{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}}},
                                     {"indices", indices},
                                     {"material", material}})}});
  };
  face(-5, 10497, 9728);
  face(-2, 33648, 9728);
  face(1, 33071, 9728);
  face(4, 10497, 9729);
  const image::Image image = draw();
  std::filesystem::remove(png);
  // Returns the fraction of red at a coordinate.
  const auto red = [&](double u, double z) {
    const glm::dvec3 color = at(image, -6.0 + 4.0 * u, z, 0.5);
    return color.x / (color.x + color.z);
  };
  struct Expected {
    double z, first, second, third;  // in the left half of each repetition
  };
  for (const Expected& e : {Expected{-5, 1, 1, 1}, Expected{-2, 1, 0, 1}, Expected{1, 1, 0, 0}}) {
    const double wanted[] = {e.first, e.second, e.third};
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(red(i + 0.25, e.z), wanted[i], 0.1) << e.z << " repetition " << i;
    EXPECT_NEAR(red(0.75, e.z), 0.0, 0.1) << e.z;
  }
  // There is a step between texels with nearest filtering, and a ramp with linear filtering.
  EXPECT_GT(red(1.40, -5.0), 0.9);
  EXPECT_GT(red(1.40, 4.0), 0.4);
  EXPECT_LT(red(1.40, 4.0), 0.85);
}

TEST(MeshTextures, LevelsAverageLightAndIgnoreHoles) {
  MeshTexture texture;
  texture.width = 4;
  texture.height = 2;
  // The left half is black and white, the right half is green with a transparent red texel.
  for (int y = 0; y < 2; ++y) {
    const std::vector<std::uint8_t> row = {0, 0, 0, 255, 255, 255, 255, 255, 0, 255, 0, 255, 255, 0, 0, 0};
    texture.rgba.insert(texture.rgba.end(), row.begin(), row.end());
  }
  const std::vector<MeshTexture> levels = mip_levels(texture);
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_EQ(levels[0].width, 2U);
  EXPECT_EQ(levels[0].height, 1U);
  EXPECT_EQ(levels[1].width, 1U);
  EXPECT_NEAR(levels[0].rgba[0], 188, 1);  // half of white in sRGB
  EXPECT_EQ(levels[0].rgba[4], 0);         // no red from the transparent texel
  EXPECT_EQ(levels[0].rgba[5], 255);
  EXPECT_EQ(levels[0].rgba[7], 128);
}

}  // namespace
}  // namespace tyndall::scene
