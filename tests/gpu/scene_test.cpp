// The demo engine on a device: all supplied scenes, shadows with parameters at the ends of their ranges, and light.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include "config/phase_file.hpp"
#include "config/scene_file.hpp"
#include "gpu_test.hpp"
#include "image/metrics.hpp"
#include "shared_scene.hpp"

namespace tyndall::scene {
namespace {

constexpr VkExtent2D kSmall = {64, 36};

// Returns parameters with tables that are built quickly. tables_test.cpp tests their accuracy.
Params with_small_tables(Params params = {}) {
  params.tables.size = {8, 32, 32, 4};
  params.tables.orders = 1;
  return params;
}

// Returns a small planet. Its horizon is near, so its terrain has few levels. Apart from the tables, levels take most
// of the time.
Params small_planet() {
  Params params = with_small_tables();
  params.planet.radius_m = 100.0e3F;
  return params;
}

class GpuScene : public SharedSceneTest {
 protected:
  // An elevation file that is removed at the end; see write_grid().
  std::string elevation_file(int n, double cell_m, const std::function<double(double x, double z)>& height) {
    file_ = std::filesystem::temp_directory_path() /
            ("tyndall-scene-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + "-" +
             std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + ".asc");
    write_grid(file_, n, cell_m, height);
    return file_.string();
  }
  void TearDown() override {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
    GpuTest::TearDown();
  }

  static Scene* make(const Params& params, const SceneParams& scene_params, VkExtent2D extent = kSmall,
                     int terrain_coarseness = 4) {
    return shared_scene(extent, params, scene_params, terrain_coarseness);
  }
  static std::unique_ptr<Scene> create(const Params& params, const SceneParams& scene_params, VkExtent2D extent,
                                       int terrain_coarseness) {
    SceneDesc desc;
    desc.extent = extent;
    desc.terrain_coarseness = terrain_coarseness;
    Result<std::unique_ptr<Scene>> scene = Scene::create(host(), desc, params, scene_params);
    EXPECT_OK(scene);
    return scene.ok() ? std::move(scene).value() : nullptr;
  }

  // Returns the radiance of a frame. Checks that it is finite, that the displayed picture is in range, and that the
  // effect makes no remarks.
  static image::Image draw(Scene& scene) {
    EXPECT_OK(scene.render(0.0));
    Result<image::Image> radiance = scene.radiance();
    Result<image::Image> display = scene.display();
    EXPECT_OK(radiance);
    EXPECT_OK(display);
    if (!radiance.ok() || !display.ok()) return {};
    for (const float value : radiance.value().rgb) EXPECT_TRUE(std::isfinite(value) && value >= 0.0F);
    for (const float value : display.value().rgb) EXPECT_TRUE(value >= 0.0F && value <= 1.0F);
    for (const std::string& note : scene.notes()) {
      // Remarks on inputs contain names of the interface. A sun without light is intended.
      const bool remark = note.find("::") != std::string::npos || note.find("record_precompute") != std::string::npos;
      EXPECT_TRUE(!remark || note.find("irradiance is 0") != std::string::npos) << note;
    }
    return std::move(radiance).value();
  }
  static image::Image draw(Scene& scene, const SceneParams& scene_params) {
    EXPECT_OK(scene.set_scene(scene_params));
    return draw(scene);
  }

 private:
  std::filesystem::path file_;
};

double luminance_sum(const image::Image& image) {
  double sum = 0.0;
  for (const float value : image.rgb) sum += static_cast<double>(value);
  return sum;
}

// The scenes are loaded one after the other, as in the viewer. The next test compares changes with new scenes.
TEST_F(GpuScene, ShippedScenesAreDrawn) {
  Scene* scene = nullptr;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TYNDALL_SOURCE_DIR "/scenes")) {
    // Presets are combined with scenes.
    if (entry.path().extension() != ".toml" || entry.path().parent_path().filename() == "presets") continue;
    config::Settings settings;
    ASSERT_TRUE(config::load(settings, entry.path().string()).ok() && config::load_files(settings).ok());
    settings.scene.camera.samples = 1;
    settings.scene.shadows.resolution = 512;  // sufficient for a small picture
    settings.effect = with_small_tables(settings.effect);
    if (scene == nullptr) scene = make(settings.effect, settings.scene);
    ASSERT_NE(scene, nullptr);
    ASSERT_OK(scene->set_params(settings.effect));
    const image::Image image = draw(*scene, settings.scene);
    EXPECT_GT(luminance_sum(image), 0.0) << entry.path();
    const auto [low, high] = std::minmax_element(image.rgb.begin(), image.rgb.end());
    EXPECT_GT(*high, 1.5F * *low) << entry.path();  // not a uniform colour
  }
  EXPECT_NE(scene, nullptr);
}

// Compares pictures as `tyndall render` and `tyndall compare` do, with the exposure of the scene and 8-bit PNGs.
TEST_F(GpuScene, EpipolarSamplingOfTerrainIsLikeBruteForce) {
  struct View {
    const char* name;
    std::function<void(SceneParams&)> change;
    double floor_db;
  };
  const View views[] = {
      {"as it is", [](SceneParams&) {}, 40.0},
      {"low sun in view",
       [](SceneParams& s) {
         s.sun.elevation_deg = 3.0F;
         s.sun.azimuth_deg = 340.0F;
         s.camera.pitch_deg = 0.0F;
       },
       40.0},
      {"in a valley, the sun at the side",
       [](SceneParams& s) {
         s.camera.altitude_m = 1500.0F;  // the scene raises it above higher ground
         s.camera.pitch_deg = 5.0F;
         s.sun.azimuth_deg = 62.0F;
       },
       40.0},
  };
  constexpr VkExtent2D kExtent = {192, 108};
  std::vector<image::Image> pictures;
  for (const Technique technique : {Technique::brute_force, Technique::epipolar}) {
    Params params = with_small_tables();
    params.scattering.technique = technique;
    Scene* const scene = make(params, {}, kExtent, 1);
    ASSERT_NE(scene, nullptr);
    for (const View& view : views) {
      SceneParams settings;
      settings.tonemap.auto_exposure = false;
      view.change(settings);
      draw(*scene, settings);
      Result<image::Image> display = scene->display();
      ASSERT_OK(display);
      for (float& value : display.value().rgb) {
        const double encoded = static_cast<double>(value) <= 0.0031308
                                   ? 12.92 * static_cast<double>(value)
                                   : 1.055 * std::pow(static_cast<double>(value), 1.0 / 2.4) - 0.055;
        value = static_cast<float>(std::round(255.0 * encoded) / 255.0);
      }
      pictures.push_back(std::move(display).value());
    }
  }
  for (std::size_t i = 0; i < std::size(views); ++i) {
    const image::Metrics metrics = image::compare(pictures[std::size(views) + i], pictures[i]);
    RecordProperty(std::string("dB: ") + views[i].name, std::to_string(metrics.psnr_db));
    EXPECT_GE(metrics.psnr_db, views[i].floor_db) << views[i].name;
  }
}

TEST_F(GpuScene, TablesFromTheCacheDrawTheSamePicture) {
  const std::filesystem::path cache =
      std::filesystem::temp_directory_path() / ("tyndall-scene-cache-" + std::to_string(::getpid()));
  SceneDesc desc;
  desc.extent = kSmall;
  desc.terrain_coarseness = 4;
  desc.make_tables.cache.place = cache.string();
  bool built = false;
  desc.make_tables.progress = [&](Progress) { built = true; };
  std::vector<image::Image> images;
  for (const bool expected : {true, false}) {
    built = false;
    Result<std::unique_ptr<Scene>> scene = Scene::create(host(), desc, small_planet(), {});
    ASSERT_OK(scene);
    EXPECT_EQ(built, expected);
    images.push_back(draw(*scene.value()));
  }
  EXPECT_EQ(images[0].rgb, images[1].rgb);
  std::filesystem::remove_all(cache);
}

// After a change, and after the change is undone, a scene draws the same picture as a new scene.
TEST_F(GpuScene, ChangesLeadToTheSamePictureAsCreation) {
  SceneParams other;
  other.terrain.seed = 7;
  other.terrain.exaggeration = 2.0F;
  other.shadows.resolution = 512;
  other.shadows.cascades = 3;
  other.shadows.first_marched = 0;
  other.sun.elevation_deg = 20.0F;
  Params air = small_planet();
  air.planet.radius_m = 120.0e3F;
  air.scattering.technique = Technique::brute_force;
  air.atmosphere.aerosol_density = 3.0F;
  const VkExtent2D larger = {80, 50};
  Scene* const changed = make(small_planet(), {});
  ASSERT_NE(changed, nullptr);
  const image::Image before = draw(*changed);
  ASSERT_OK(changed->set_extent(larger));
  ASSERT_OK(changed->set_params(air));
  const image::Image after = draw(*changed, other);
  const std::unique_ptr<Scene> created = create(air, other, larger, 4);
  ASSERT_NE(created, nullptr);
  EXPECT_EQ(after.width, larger.width);
  EXPECT_EQ(after.rgb, draw(*created).rgb);
  ASSERT_OK(changed->set_extent(kSmall));
  ASSERT_OK(changed->set_params(small_planet()));
  EXPECT_EQ(draw(*changed, {}).rgb, before.rgb);
}

// Viewers use these options: reused shadow maps, tables built in slices, and coarser terrain.
TEST_F(GpuScene, DrawsForViewers) {
  SceneDesc desc;
  desc.extent = kSmall;
  desc.tables_later = true;
  desc.timings = true;
  Result<std::unique_ptr<Scene>> made = Scene::create(host(), desc, small_planet(), {});
  ASSERT_OK(made);
  Scene& scene = *made.value();
  EXPECT_FALSE(scene.can_render());
  int steps = 0;
  for (Result<Progress> progress = scene.effect().precompute_progress(); !progress.value().complete(); ++steps) {
    progress = scene.advance_tables(4);
    ASSERT_OK(progress);
  }
  EXPECT_GT(steps, 2);
  ASSERT_TRUE(scene.can_render());
  Scene* const plain = make(small_planet(), {}, kSmall, 1);
  ASSERT_NE(plain, nullptr);
  const image::Image whole = draw(*plain);
  EXPECT_EQ(draw(scene).rgb, whole.rgb);
  const auto drawn = [&scene](std::string_view pass) {
    return std::any_of(scene.timings().begin(), scene.timings().end(),
                       [&](const PassTime& t) { return t.name == pass; });
  };
  EXPECT_TRUE(drawn("shadow_maps"));
  EXPECT_EQ(draw(scene).rgb, whole.rgb);
  EXPECT_FALSE(drawn("shadow_maps"));
  SceneParams low_sun;
  low_sun.sun.elevation_deg = 4.0F;
  EXPECT_EQ(draw(scene, low_sun).rgb, draw(*plain, low_sun).rgb);
  EXPECT_TRUE(drawn("shadow_maps"));
  // Coarser terrain differs only slightly. In a narrow field of view, the cells of a picture this small are fine.
  SceneParams narrow;
  narrow.camera.fov_deg = 4.5F;
  narrow.camera.pitch_deg = -28.0F;
  const image::Image fine = draw(*plain, narrow);
  desc.tables_later = false;
  desc.terrain_coarseness = 4;
  Result<std::unique_ptr<Scene>> coarse = Scene::create(host(), desc, small_planet(), {});
  ASSERT_OK(coarse);
  const image::Image rough = draw(*coarse.value(), narrow);
  EXPECT_NE(rough.rgb, fine.rgb);
  EXPECT_NEAR(luminance_sum(rough), luminance_sum(fine), 0.03 * luminance_sum(fine));
}

TEST_F(GpuScene, TheDefaultSceneRepeatsItselfAndIsDarkAtNight) {
  SceneParams settings;
  Scene* const scene = make(with_small_tables(), settings);
  ASSERT_NE(scene, nullptr);
  const image::Image first = draw(*scene);
  EXPECT_GT(luminance_sum(first), 0.0);
  EXPECT_EQ(draw(*scene).rgb, first.rgb);
  // The ground below is in the planet's shadow: there is no sun and almost no light from the sky.
  settings.camera.pitch_deg = -60.0F;
  settings.sun.elevation_deg = 30.0F;
  const image::Image day = draw(*scene, settings);
  settings.sun.elevation_deg = -10.0F;
  const image::Image night = draw(*scene, settings);
  for (std::size_t i = 0; i < night.rgb.size(); ++i) {
    ASSERT_GT(day.rgb[i], 1e-3F) << i;
    // At -10 degrees, single scattering comes from above 90 km, apart from grazing rays of the sun. It is thousands of
    // times weaker than by day.
    ASSERT_LT(night.rgb[i], 1e-3F * day.rgb[i]) << i;
  }
}

TEST_F(GpuScene, ShadowParametersAtBothEnds) {
  Params params = small_planet();
  SceneParams least;
  least.camera.position_m = {0.0F, 2500.0F, 0.0F};
  SceneParams most = least;
  // Many large maps together would only test the amount of memory.
  least.shadows = {4096, 1, 0, 0.0F, 1000.0F, false, false, false};
  most.shadows = {512, 8, 7, 1.0F, 1.0e7F, true, true, true};
  for (const SceneParams& settings : {least, most}) {
    Scene* const scene = make(params, settings);
    ASSERT_NE(scene, nullptr);
    EXPECT_GT(luminance_sum(draw(*scene)), 0.0);
  }
}

TEST_F(GpuScene, ShadingsTheCascadeViewAndTheSunsDisc) {
  Params params = small_planet();
  params.scattering.enabled = false;  // only the light of the ground
  params.scattering.scale = 1.0F;
  SceneParams settings;
  settings.terrain.source = elevation_file(
      64, 300.0, [](double x, double z) { return 800.0 + 500.0 * std::sin(x / 1500.0) * std::cos(z / 1900.0); });
  settings.camera.position_m = {0.0F, 3000.0F, 0.0F};
  settings.camera.pitch_deg = -35.0F;
  settings.sun.elevation_deg = 40.0F;
  Scene* const scene = make(params, settings);
  ASSERT_NE(scene, nullptr);
  std::vector<std::vector<float>> images;
  for (const TerrainShading shading : {TerrainShading::materials, TerrainShading::height, TerrainShading::plain}) {
    settings.terrain.shading = shading;
    images.push_back(draw(*scene, settings).rgb);
  }
  EXPECT_NE(images[0], images[1]);
  EXPECT_NE(images[1], images[2]);
  settings.shadows.show_cascades = true;
  const image::Image cascades = draw(*scene, settings);
  // Textured ground has colours, plain ground has none.
  double saturation = 0.0;
  for (std::size_t i = 0; i < cascades.rgb.size(); i += 3) {
    const auto spread = [i](const std::vector<float>& rgb) {
      const auto [low, high] = std::minmax({rgb[i], rgb[i + 1], rgb[i + 2]});
      return (high - low) / high;
    };
    saturation = std::max(saturation, static_cast<double>(spread(cascades.rgb) - spread(images[2])));
  }
  EXPECT_GT(saturation, 0.1);

  // The disc covers 450 pixels. Its radiance times its solid angle is the irradiance, with or without limb darkening.
  settings.sun.elevation_deg = settings.camera.pitch_deg = 30.0F;
  settings.sun.azimuth_deg = settings.camera.yaw_deg = 0.0F;
  settings.sun.irradiance = {3.0F, 2.0F, 0.5F};
  settings.sun.angular_radius_deg = 2.0F;
  settings.camera.fov_deg = 6.0F;
  const image::Image disc = draw(*scene, settings);
  const double side = 2.0 * std::tan(3.0 * std::numbers::pi / 180.0) / kSmall.height;
  double sum[3] = {};
  for (std::uint32_t y = 0; y < kSmall.height; ++y) {
    for (std::uint32_t x = 0; x < kSmall.width; ++x) {
      const double u = (x + 0.5 - 0.5 * kSmall.width) * side;
      const double v = (y + 0.5 - 0.5 * kSmall.height) * side;
      const double solid_angle = side * side / std::pow(1.0 + u * u + v * v, 1.5);
      for (std::size_t c = 0; c < 3; ++c) {
        sum[c] += solid_angle * static_cast<double>(disc.rgb[3 * (y * kSmall.width + x) + c]);
      }
    }
  }
  // The edge is a ramp of one pixel, at the darkest part of the limb.
  const double irradiance[3] = {3.0, 2.0, 0.5};
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], irradiance[c], 0.01 * irradiance[c]);
}

// With every model, the light of a channel depends only on the sun's light in that channel, on the ground, in the sky,
// on the moon and on the sun's disc.
TEST_F(GpuScene, EveryModelTakesTheColourOfTheSun) {
  const Params params = small_planet();
  SceneParams scene_params;
  scene_params.sun.elevation_deg = 12.0F;
  scene_params.sun.azimuth_deg = 3.0F;
  scene_params.sun.angular_radius_deg = 2.0F;
  scene_params.camera.yaw_deg = 0.0F;
  scene_params.camera.pitch_deg = 0.0F;
  scene_params.camera.fov_deg = 60.0F;
  scene_params.moon = {true, 20.0F, -15.0F, 3.0F};
  scene_params.shadows.resolution = 512;
  scene_params.shadows.cascades = 1;
  scene_params.shadows.first_marched = 0;
  Scene* const scene = make(params, scene_params);
  ASSERT_NE(scene, nullptr);
  const Vec3 color(3.0F, 1.5F, 0.25F);
  const auto expect_colored = [&](const char* what) {
    scene_params.sun.irradiance = Vec3(1.0F);
    const image::Image white = draw(*scene, scene_params);
    scene_params.sun.irradiance = color;
    const image::Image colored = draw(*scene, scene_params);
    const float parts[3] = {color.x, color.y, color.z};
    double worst = 0.0;
    for (std::size_t i = 0; i < white.rgb.size(); ++i) {
      const double expected = static_cast<double>(white.rgb[i]) * static_cast<double>(parts[i % 3]);
      if (expected > 1e-12) worst = std::max(worst, std::abs(static_cast<double>(colored.rgb[i]) / expected - 1.0));
    }
    EXPECT_LT(worst, 1e-5) << what;
    EXPECT_GT(luminance_sum(white), 0.0) << what;
  };
  expect_colored("atmosphere");
  Params medium = params;
  medium.scattering.medium = MediumKind::homogeneous;
  ASSERT_OK(scene->set_params(medium));
  expect_colored("homogeneous medium");
  for (const ScatteringModel model :
       {ScatteringModel::homogeneous, ScatteringModel::oneil, ScatteringModel::oneil_table}) {
    scene_params.scattering.model = model;
    expect_colored("model");
  }
  scene_params.oneil.ground = OneilGround::sphere;
  expect_colored("sphere");
}

TEST_F(GpuScene, SmoothGroundUnderAHighSunHasNoAcne) {
  Params params = with_small_tables();
  params.scattering.enabled = false;
  SceneParams settings;
  // The visible slopes are at most 13 degrees steep, so none faces away from a sun at 60 degrees. Outside the view, in
  // the west, is a mountain range of 2 km whose shadow is short under a high sun.
  settings.terrain.source = elevation_file(256, 200.0, [](double x, double z) {
    const double range = (x + 6000.0) / 800.0;
    return 800.0 + 350.0 * std::sin(x / 1500.0) * std::cos(z / 1500.0) + 2000.0 * std::exp(-range * range);
  });
  settings.terrain.shading = TerrainShading::plain;
  // The view is from 2.2 km above the mean ground, and shows ground 10 to 20 km away.
  settings.camera = {{0.0F, 3000.0F, 0.0F}, -1.0F, 0.0F, -9.0F, 3.0F, 1};
  settings.sun.elevation_deg = 60.0F;
  settings.sun.azimuth_deg = 270.0F;
  Scene* const scene = make(params, settings, kSmall, 1);
  ASSERT_NE(scene, nullptr);
  // For a picture without shadows, the cascades end at twice the height of the camera, in front of everything visible.
  SceneParams open_settings = settings;
  open_settings.shadows.distance_m = 1000.0F;
  const auto lit_fraction = [&] {
    const image::Image shadowed = draw(*scene, settings);
    const image::Image open = draw(*scene, open_settings);
    std::size_t lit = 0;
    std::size_t count = 0;
    for (std::size_t i = 1; i < open.rgb.size(); i += 3) {
      if (open.rgb[i] <= 0.0F) continue;
      ++count;
      lit += shadowed.rgb[i] >= 0.999F * open.rgb[i] ? 1 : 0;
    }
    EXPECT_EQ(count, static_cast<std::size_t>(kSmall.width) * kSmall.height);
    return static_cast<double>(lit) / static_cast<double>(count);
  };
  EXPECT_GE(lit_fraction(), 0.999);
  // Under a low sun behind the range, shadows are visible. (Slopes that face away are dark in both.)
  settings.sun.elevation_deg = open_settings.sun.elevation_deg = 10.0F;
  EXPECT_LT(lit_fraction(), 0.5);
}

}  // namespace
}  // namespace tyndall::scene
