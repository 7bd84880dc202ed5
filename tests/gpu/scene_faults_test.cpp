// Creating, changing and drawing a scene run out of memory at every allocation. The call must return an error and leak
// nothing, the scene must draw the same picture as before, and the same call must succeed afterwards.
#include <unistd.h>

#include <array>
#include <filesystem>
#include <functional>

#include "faults.hpp"
#include "gpu_test.hpp"
#include "mesh_files.hpp"
#include "scene/scene.hpp"

namespace tyndall::scene {
namespace {

using faults::Kind;
constexpr std::array<Kind, 3> kKinds = {Kind::vulkan, Kind::submission, Kind::host};
constexpr long kMaxCalls = 5000;
using Change = std::function<Result<void>(Scene&)>;

// Saves a pane of coloured glass to a file, which is removed at the end.
class Pane {
 public:
  Pane() {
    GltfFile file;
    const int glass = file.material({{"pbrMetallicRoughness", {{"baseColorFactor", {1.0, 0.2, 0.1, 1.0}}}},
                                     {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1.0}}}}}});
    file.root["extensionsUsed"] = {"KHR_materials_transmission"};
    file.level_quad(-500.0F, -500.0F, 500.0F, 500.0F, 300.0F, glass);
    file_ = std::filesystem::temp_directory_path() / ("tyndall-pane-" + std::to_string(getpid()) + ".glb");
    file.save(file_.string());
  }
  ~Pane() {
    std::error_code ignored;
    std::filesystem::remove(file_, ignored);
  }
  Pane(const Pane&) = delete;
  Pane& operator=(const Pane&) = delete;
  [[nodiscard]] std::string path() const { return file_.string(); }

 private:
  std::filesystem::path file_;
};

// Returns parameters with integrated single scattering, so that the tables are small and quickly built.
Params small_params() {
  Params params;
  params.tables.size = {4, 8, 8, 4};
  params.tables.orders = 1;
  params.planet.radius_m = 100.0e3F;
  params.epipolar.slices = 512;
  params.epipolar.samples = 64;
  return params;
}

SceneParams small_scene() {
  SceneParams scene;
  scene.shadows.cascades = 2;
  scene.shadows.resolution = 512;
  scene.tonemap.auto_exposure = false;
  return scene;
}

SceneDesc small_desc() {
  SceneDesc desc;
  desc.extent = {32, 18};
  desc.terrain_coarseness = 4;
  desc.make_tables.cache.place = "off";
  return desc;
}

// Returns a scene with other terrain and shadow maps, and a model with glass.
SceneParams other_scene(const std::string& model) {
  SceneParams scene = small_scene();
  scene.shadows.cascades = 3;
  scene.shadows.resolution = 600;
  scene.terrain.seed = 7;
  scene.meshes.source = model;
  return scene;
}

// Returns another planet, which changes terrain, meshes, effect and tables.
Params other_params() {
  Params params = small_params();
  params.planet.radius_m = 120.0e3F;
  params.tables.size = {4, 8, 12, 4};
  params.epipolar.slices = 600;
  return params;
}

// Tests on the fake device of faults.hpp.
class SceneFaults : public testing::Test {
 protected:
  void SetUp() override {
    gpu::HostDesc desc;
    desc.get_instance_proc_addr = faults::get_fake_proc_addr;
    Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create(desc);
    ASSERT_OK(host);
    host_ = std::move(host).value();
    ASSERT_OK(host_->sets().allocate({}));  // the host retains the pool until it is destroyed
    objects_ = faults::live_objects();
    pipelines_ = faults::live_pipeline_objects();
  }
  void TearDown() override {
    EXPECT_EQ(faults::live_objects(), objects_);
    EXPECT_EQ(faults::live_pipeline_objects(), pipelines_);
    host_.reset();
  }

  Result<std::unique_ptr<Scene>> create() const { return Scene::create(*host_, desc_, params_, scene_); }
  std::unique_ptr<Scene> make() const {
    Result<std::unique_ptr<Scene>> made = create();
    EXPECT_OK(made);
    return made ? std::move(made).value() : nullptr;
  }

  // The state that a failed call must not change.
  struct Observed {
    std::size_t objects = 0;
    std::size_t commands = 0;
    VkDeviceSize scene_bytes = 0, effect_bytes = 0;
    Progress progress;
    std::vector<std::string> notes;
  };
  static void expect_same(const Observed& a, const Observed& b, const std::string& where) {
    EXPECT_EQ(a.objects, b.objects) << where;
    EXPECT_EQ(a.commands, b.commands) << where;
    EXPECT_EQ(a.scene_bytes, b.scene_bytes) << where;
    EXPECT_EQ(a.effect_bytes, b.effect_bytes) << where;
    EXPECT_EQ(a.progress.complete(), b.progress.complete()) << where;
    EXPECT_EQ(a.notes, b.notes) << where;
  }
  static std::size_t draw(Scene& scene) {
    faults::forget_commands();
    EXPECT_OK(scene.render(0.0));
    return faults::command_hash();
  }
  static Observed observe(Scene& scene) {
    Observed out;
    out.objects = faults::live_objects();
    out.commands = draw(scene);
    const Scene::Memory memory = scene.memory();
    out.scene_bytes = memory.scene;
    out.effect_bytes = memory.effect_persistent;
    out.progress = scene.effect().precompute_progress();
    out.notes = scene.notes();
    return out;
  }

  // Lets `change` fail at every call of each kind. There must be at least `min_refused` failures of each kind.
  void refuse_everywhere(const std::string& name, const std::array<long, 3>& min_refused, const Change& change) {
    std::unique_ptr<Scene> scene;
    Observed before;
    const auto start_again = [&] {
      scene = make();
      ASSERT_NE(scene, nullptr);
      for (int i = 0; i < 4; ++i) draw(*scene);  // old objects are freed after some frames
      before = observe(*scene);
    };
    for (std::size_t k = 0; k < kKinds.size(); ++k) {
      start_again();
      long refused = 0;
      for (long n = 0; n < kMaxCalls; ++n) {
        const std::string where = name + ", kind " + std::to_string(k) + ", " + std::to_string(n);
        faults::arm(kKinds[k], n);
        const Result<void> changed = change(*scene);
        if (!faults::disarm()) {
          EXPECT_OK(changed);
          break;
        }
        if (changed.ok()) {  // the change succeeded without that call
          draw(*scene);
          start_again();
          continue;
        }
        ++refused;
        EXPECT_EQ(changed.error().code, ErrorCode::out_of_memory) << where << ": " << changed.error().message;
        for (int i = 0; i < 4; ++i) draw(*scene);
        expect_same(before, observe(*scene), where);
        if (HasFailure()) return;
      }
      draw(*scene);  // the changed scene can be drawn
      EXPECT_GE(refused, min_refused[k]) << name << ", kind " << k;
    }
  }

  SceneDesc desc_ = small_desc();
  Params params_ = small_params();
  SceneParams scene_ = small_scene();

 private:
  std::unique_ptr<gpu::Host> host_;
  std::size_t objects_ = 0, pipelines_ = 0;
};

TEST_F(SceneFaults, CreationIsRefusedAtEveryCall) {
  const Pane pane;
  scene_ = other_scene(pane.path());
  desc_.timings = true;
  for (const Kind kind : kKinds) {
    const std::size_t objects = faults::live_objects();
    const std::size_t pipelines = faults::live_pipeline_objects();
    long refused = 0;
    for (long n = 0; n < kMaxCalls; ++n) {
      faults::arm(kind, n);
      const Result<std::unique_ptr<Scene>> made = create();
      if (!faults::disarm()) {
        EXPECT_OK(made);
        break;
      }
      if (made.ok()) continue;  // the scene was created without that call
      ++refused;
      EXPECT_EQ(made.error().code, ErrorCode::out_of_memory) << n << ": " << made.error().message;
      EXPECT_EQ(faults::live_objects(), objects) << n;
      EXPECT_EQ(faults::live_pipeline_objects(), pipelines) << n;
    }
    EXPECT_GE(refused, kind == Kind::vulkan ? 300 : kind == Kind::submission ? 15 : 250);
  }
}

TEST_F(SceneFaults, AnotherSceneIsRefusedAtEveryCall) {
  const Pane pane;
  const SceneParams other = other_scene(pane.path());
  refuse_everywhere("set_scene", {80, 8, 200}, [&](Scene& s) { return s.set_scene(other); });
}

TEST_F(SceneFaults, OtherParametersAreRefusedAtEveryCall) {
  const Params other = other_params();
  refuse_everywhere("set_params", {70, 4, 10}, [&](Scene& s) { return s.set_params(other); });
}

TEST_F(SceneFaults, AnotherSizeIsRefusedAtEveryCall) {
  refuse_everywhere("set_extent", {15, 0, 0}, [](Scene& s) { return s.set_extent({40, 20}); });
}

TEST_F(SceneFaults, AnotherModelIsRefusedAtEveryCall) {
  for (const ScatteringModel model : {ScatteringModel::homogeneous, ScatteringModel::oneil}) {
    SceneParams scene = small_scene();
    scene.scattering.model = model;
    refuse_everywhere("scattering.model", {20, 2, 5}, [&](Scene& s) { return s.set_scene(scene); });
  }
}

// The first frame fills the terrain, in one submission, and adapts the exposure. If it fails at any call, the scene
// later draws the same picture as a scene without failures. After a failed submission, the effect is created again.
TEST_F(SceneFaults, AFailedFrameHasNoEffectOnLaterOnes) {
  const Pane pane;
  scene_ = other_scene(pane.path());
  scene_.tonemap.auto_exposure = true;
  desc_.timings = true;
  for (const bool in_parts : {false, true}) {
    desc_.in_parts = desc_.reuse_shadows = in_parts;
    std::unique_ptr<Scene> whole = make();
    ASSERT_NE(whole, nullptr);
    for (int i = 0; i < 4; ++i) draw(*whole);
    const Observed right = observe(*whole);
    whole.reset();
    for (const Kind kind : kKinds) {
      long refused = 0;
      for (long n = 0; n < kMaxCalls; ++n) {
        const std::string where = "kind " + std::to_string(static_cast<int>(kind)) + ", " + std::to_string(n);
        const std::unique_ptr<Scene> scene = make();
        ASSERT_NE(scene, nullptr);
        faults::arm(kind, n);
        const Result<void> drawn = scene->render(0.0);
        if (!faults::disarm()) {
          EXPECT_OK(drawn);
          break;
        }
        if (!drawn.ok()) {
          ++refused;
          EXPECT_EQ(drawn.error().code, ErrorCode::out_of_memory) << where;
        }
        for (int i = 0; i < 4; ++i) draw(*scene);
        expect_same(right, observe(*scene), where);
      }
      EXPECT_GE(refused, kind == Kind::vulkan ? 10 : kind == Kind::submission ? (in_parts ? 10 : 6) : 40);
    }
  }
}

// On a real device, only some of the calls fail. The picture must be unchanged byte for byte.
class SceneFaultsOnDevice : public testing::Test {
 protected:
  void SetUp() override {
    gpu::HostDesc desc;
    desc.validation = true;
    desc.validation_log = &messages_;
    desc.get_instance_proc_addr = faults::get_instance_proc_addr;
    Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create(desc);
    ASSERT_OK(host);
    host_ = std::move(host).value();
    SceneDesc scene = small_desc();
    scene.make_tables.slice_budget = 14;  // the tables are built in two submissions
    Result<std::unique_ptr<Scene>> made = Scene::create(*host_, scene, small_params(), small_scene());
    ASSERT_OK(made);
    scene_ = std::move(made).value();
  }
  void TearDown() override {
    scene_.reset();
    host_.reset();
    for (const std::string& message : messages_) ADD_FAILURE() << message;
  }
  std::vector<float> draw() {
    EXPECT_OK(scene_->render(0.0));
    Result<image::Image> picture = scene_->radiance();
    EXPECT_OK(picture);
    return picture ? picture.value().rgb : std::vector<float>();
  }
  // Lets `change` fail at every `step`th call that creates something. Returns the number of failures.
  long refuse(const std::string& name, const Change& change, long step) {
    const std::vector<float> before = draw();
    long refused_calls = 0;
    for (long n = 0; n < kMaxCalls; n += step) {
      const std::string where = name + ", Vulkan call " + std::to_string(n);
      faults::arm(Kind::vulkan, n);
      const Result<void> refused = change(*scene_);
      const bool failed = faults::disarm();
      EXPECT_EQ(refused.ok(), !failed) << where;
      if (!failed) return refused_calls;
      ++refused_calls;
      EXPECT_EQ(draw(), before) << where;
    }
    return -1;
  }

  std::unique_ptr<Scene> scene_;

 private:
  std::vector<std::string> messages_;  // outlives the host
  std::unique_ptr<gpu::Host> host_;
};

TEST_F(SceneFaultsOnDevice, ThePictureIsUnchanged) {
  const Pane pane;
  const std::vector<float> first = draw();
  const SceneParams other = other_scene(pane.path());
  EXPECT_GE(refuse(
                "set_scene", [&](Scene& s) { return s.set_scene(other); }, 23),
            3);
  const std::vector<float> with_pane = draw();
  EXPECT_NE(with_pane, first);
  EXPECT_GE(refuse(
                "set_params", [](Scene& s) { return s.set_params(other_params()); }, 29),
            3);
  EXPECT_NE(draw(), with_pane);
}

// The commands of a frame, and those of a build of the tables, are recorded but not submitted.
TEST_F(SceneFaultsOnDevice, ThePictureIsUnchangedWhenSubmittingFails) {
  const std::vector<float> first = draw();
  faults::arm(Kind::submission, 0);
  EXPECT_FALSE(scene_->render(0.0).ok());
  EXPECT_TRUE(faults::disarm());
  EXPECT_EQ(draw(), first);
  Params params = small_params();
  params.atmosphere.aerosol_density = 3.0F;
  long refused_calls = 0;
  for (;; ++refused_calls) {
    faults::arm(Kind::submission, refused_calls);
    const Result<void> refused = scene_->set_params(params);
    if (!faults::disarm()) break;
    EXPECT_FALSE(refused.ok()) << refused_calls;
    EXPECT_EQ(draw(), first) << refused_calls;
  }
  EXPECT_EQ(refused_calls, 2);
  EXPECT_NE(draw(), first);
}

}  // namespace
}  // namespace tyndall::scene
