// A scene that is refused other parameters, because memory runs out at any place, draws the picture that it drew
// before.
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "faults.hpp"
#include "gpu_test.hpp"
#include "mesh_files.hpp"
#include "scene/scene.hpp"

namespace tyndall::scene {
namespace {

class SceneFaults : public testing::Test {
 protected:
  void SetUp() override {
    gpu::HostDesc desc;
    desc.validation = true;
    desc.validation_log = &messages_;
    desc.get_instance_proc_addr = faults::get_instance_proc_addr;
    Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create(desc);
    ASSERT_OK(host);
    host_ = std::move(host).value();
    // Light scattered once and integrated: the tables are small, and made in a moment.
    params_.tables.size = {4, 8, 8, 4};
    params_.tables.orders = 1;
    params_.planet.radius_m = 100.0e3F;
    params_.epipolar.slices = 512;
    params_.epipolar.samples = 64;
    scene_.shadows.cascades = 2;
    scene_.shadows.resolution = 512;
    scene_.tonemap.auto_exposure = false;
    SceneDesc scene;
    scene.extent = {32, 18};
    scene.terrain_coarseness = 4;
    scene.make_tables.cache.place = "off";
    Result<std::unique_ptr<Scene>> made = Scene::create(*host_, scene, params_, scene_);
    ASSERT_OK(made);
    made_ = std::move(made).value();
  }
  void TearDown() override {
    made_.reset();
    host_.reset();
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
    for (const std::string& message : messages_) ADD_FAILURE() << message;
  }

  // A pane of coloured glass in the air, in a file that is removed at the end.
  std::string pane() {
    GltfFile file;
    const int glass = file.material({{"pbrMetallicRoughness", {{"baseColorFactor", {1.0, 0.2, 0.1, 1.0}}}},
                                     {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}}}}});
    file.root["extensionsUsed"] = {"KHR_materials_transmission"};
    file.level_quad(-500.0F, -500.0F, 500.0F, 500.0F, 300.0F, glass);
    file_ = std::filesystem::temp_directory_path() / ("tyndall-pane-" + std::to_string(getpid()) + ".glb");
    return file.save(file_.string());
  }
  std::vector<float> draw() {
    EXPECT_OK(made_->render(0.0));
    Result<image::Image> picture = made_->radiance();
    EXPECT_OK(picture);
    return picture ? picture.value().rgb : std::vector<float>();
  }

  // Refuses `change` at every `step`th call that creates something. Returns how many were refused.
  long refuse_everywhere(const std::string& name, const std::function<Result<void>()>& change, long step) {
    const std::vector<float> before = draw();
    const Scene::Memory memory = made_->memory();
    long refused_calls = 0;
    for (long n = 0; n < 3000; n += step) {
      const std::string where = name + ", Vulkan call " + std::to_string(n);
      faults::arm(faults::Kind::vulkan, n);
      const Result<void> refused = change();
      const bool failed = faults::disarm();
      EXPECT_EQ(refused.ok(), !failed) << where;
      if (!failed) return refused_calls;
      ++refused_calls;
      EXPECT_EQ(draw(), before) << where;
      EXPECT_EQ(made_->memory().scene, memory.scene) << where;
      EXPECT_EQ(made_->memory().effect_persistent, memory.effect_persistent) << where;
    }
    return -1;
  }

  Params params_;
  SceneParams scene_;
  std::unique_ptr<Scene> made_;

 private:
  std::vector<std::string> messages_;  // outlives the host
  std::unique_ptr<gpu::Host> host_;
  std::filesystem::path file_;
};

TEST_F(SceneFaults, RefusedParametersLeaveThePicture) {
  const std::vector<float> first = draw();
  // Shadow maps, terrain and meshes with glass, in one step.
  SceneParams other = scene_;
  other.shadows.cascades = 3;
  other.shadows.resolution = 600;
  other.terrain.seed = 7;
  other.meshes.source = pane();
  EXPECT_GE(refuse_everywhere(
                "set_scene", [&] { return made_->set_scene(other); }, 17),
            4);
  const std::vector<float> with_pane = draw();
  EXPECT_NE(with_pane, first);

  // Another planet: terrain, meshes, effect and tables.
  Params params = params_;
  params.planet.radius_m = 120.0e3F;
  params.tables.size = {4, 8, 12, 4};
  params.epipolar.slices = 600;
  EXPECT_GE(refuse_everywhere(
                "set_params", [&] { return made_->set_params(params); }, 19),
            4);
  EXPECT_NE(draw(), with_pane);

  EXPECT_GE(refuse_everywhere(
                "set_extent",
                [&] {
                  return made_->set_extent({40, 20});
                },
                5),
            3);
  EXPECT_EQ(draw().size(), 3U * 40U * 20U);

  // A model that draws by itself, without meshes.
  SceneParams model = other;
  model.meshes.source = "none";
  model.scattering.model = ScatteringModel::homogeneous;
  EXPECT_GE(refuse_everywhere(
                "scattering.model", [&] { return made_->set_scene(model); }, 11),
            2);
  draw();
}

}  // namespace
}  // namespace tyndall::scene
