// Frames that are recorded while the previous one executes, as the viewer does on a GPU.
#include <gtest/gtest.h>

#include <array>

#include "gpu_test.hpp"
#include "scene/scene.hpp"

namespace tyndall::scene {
namespace {

class GpuSceneAhead : public GpuTest {
 protected:
  static std::unique_ptr<Scene> create(bool ahead, const Params& params, const SceneParams& scene) {
    SceneDesc desc;
    desc.extent = {64, 36};
    desc.terrain_coarseness = 4;
    desc.timings = true;
    desc.ahead_up_to_ms = ahead ? 1.0e6 : 0.0;
    desc.in_parts = ahead;
    Result<std::unique_ptr<Scene>> made = Scene::create(host(), desc, params, scene);
    EXPECT_OK(made);
    return made.ok() ? std::move(made).value() : nullptr;
  }
};

// Draws the same frames in two scenes, one of which waits for each frame. The camera and the sun move with every frame,
// so that a frame that read the constants of another would differ.
TEST_F(GpuSceneAhead, DrawsTheSameFramesAsWhenItWaitsForEach) {
  Params params;
  params.tables.size = {8, 32, 32, 4};
  params.tables.orders = 1;
  params.planet.radius_m = 100.0e3F;  // a near horizon needs little terrain
  SceneParams scene;
  scene.shadows.resolution = 512;
  scene.shadows.cascades = 2;
  scene.camera.position_m = {0, 1500, 0};
  scene.tonemap.auto_exposure = true;
  scene.tonemap.light_adaptation = true;
  const std::array<std::unique_ptr<Scene>, 2> scenes = {create(false, params, scene), create(true, params, scene)};
  ASSERT_NE(scenes[0], nullptr);
  ASSERT_NE(scenes[1], nullptr);
  Params other_air = params;
  other_air.atmosphere.aerosol_density = 3.0F;
  struct Part {
    const char* name;
    ScatteringModel model;
    VkExtent2D extent;
    const Params* params;
  };
  double seconds = 0.0;
  for (const Part& part : {Part{"first", ScatteringModel::atmosphere, {64, 36}, &params},
                           Part{"other model", ScatteringModel::oneil_table, {64, 36}, &params},
                           Part{"other size and air", ScatteringModel::homogeneous, {80, 45}, &other_air},
                           Part{"other tables", ScatteringModel::atmosphere, {80, 45}, &other_air}}) {
    SCOPED_TRACE(part.name);
    scene.scattering.model = part.model;
    std::array<image::Image, 2> pictures;
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_OK(scenes[i]->set_extent(part.extent));
      ASSERT_OK(scenes[i]->set_params(*part.params));
      SceneParams moving = scene;
      for (int frame = 0; frame < 4; ++frame) {
        moving.camera.yaw_deg += 20.0;
        moving.camera.position_m.y += 100.0;
        moving.sun.elevation_deg += 5.0F;
        ASSERT_OK(scenes[i]->set_scene(moving));
        ASSERT_OK(scenes[i]->render(seconds + 0.1 * frame));
      }
      Result<image::Image> display = scenes[i]->display();
      ASSERT_OK(display);
      pictures[i] = std::move(display).value();
      ASSERT_OK(scenes[i]->finish());
      ASSERT_OK(scenes[i]->tone(0.05));
    }
    seconds += 1.0;
    EXPECT_EQ(pictures[0].rgb, pictures[1].rgb);
    EXPECT_EQ(scenes[0]->exposure().measurement.luminance, scenes[1]->exposure().measurement.luminance);
    EXPECT_GT(scenes[0]->exposure().measurement.luminance, 0.0F);
    ASSERT_EQ(scenes[0]->timings().size(), scenes[1]->timings().size());
    EXPECT_FALSE(scenes[1]->timings().empty());
  }
}

}  // namespace
}  // namespace tyndall::scene
