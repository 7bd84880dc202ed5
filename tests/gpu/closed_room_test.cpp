// A closed room without windows, seen from inside. Without light from the sky (meshes.sky_light = 0), surfaces and
// in-scattering must be black, so any light has leaked in.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "gpu_test.hpp"
#include "mesh_files.hpp"
#include "shared_scene.hpp"

namespace tyndall::scene {
namespace {

constexpr VkExtent2D kExtent = {128, 72};
constexpr Point kInside = {6.0F, 8.0F, 5.0F};  // half the width, the height, half the depth [m]

// Saves a room of six slabs, each of which is a closed mesh.
std::string save_room(const std::string& path, float wall_m) {
  GltfFile file;
  const int grey = file.material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}});
  const auto slab = [&](const Point& a, const Point& b) {
    std::vector<Point> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back({(i & 1) != 0 ? b[0] : a[0], (i & 2) != 0 ? b[1] : a[1], (i & 4) != 0 ? b[2] : a[2]});
    const int position = file.points(corners);
    const int indices = file.accessor<std::uint16_t>(
        {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6},
        5123, "SCALAR", 1);
    file.node(
        {{"mesh", file.mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}, {"material", grey}})}});
  };
  const auto [x, y, z] = kInside;
  const float w = wall_m;
  slab({-x - w, -w, -z - w}, {x + w, 0, z + w});
  slab({-x - w, y, -z - w}, {x + w, y + w, z + w});
  slab({-x - w, 0, -z - w}, {-x, y, z + w});
  slab({x, 0, -z - w}, {x + w, y, z + w});
  slab({-x, 0, -z - w}, {x, y, -z});
  slab({-x, 0, z}, {x, y, z + w});
  return file.save(path);
}

class GpuClosedRoom : public SharedSceneTest {
 protected:
  GpuClosedRoom()
      : path_((std::filesystem::temp_directory_path() /
               ("tyndall-room-" + std::to_string(::getpid()) + "-" +
                testing::UnitTest::GetInstance()->current_test_info()->name() + ".glb"))
                  .string()) {
    params_.tables.size = {8, 32, 32, 4};
    params_.tables.orders = 2;
    params_.planet.radius_m = 100.0e3F;  // few levels of terrain
    scene_.camera.fov_deg = 70.0F;
    scene_.meshes.sky_light = 0.0F;
  }
  void TearDown() override {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    GpuTest::TearDown();
  }

  Scene* make(const char* terrain, float wall_m) {
    scene_.terrain.source = terrain;
    scene_.meshes.source = save_room(path_, wall_m);
    // The terrain must be below the floor.
    scene_.meshes.position_m.y = scene_.terrain.source == "none" ? 0.0 : 20.0;
    Scene* const scene = shared_scene(kExtent, params_, scene_, 1);
    if (scene == nullptr) return nullptr;
    const std::shared_ptr<const ElevationSource> ground = scene->elevations();
    floor_m_ = scene_.meshes.position_m.y;
    if (ground != nullptr) floor_m_ += ground_height(*ground, {0.0, 1.0, 0.0}, params_.planet.radius_m);
    return scene;
  }
  // Draws views into opposite corners, downwards and upwards, under suns from the zenith to the horizon.
  void expect_dark(Scene& scene, std::uint32_t cascades, float distance_m, const std::string& what) {
    scene_.shadows.cascades = cascades;
    scene_.shadows.first_marched = std::min(1U, cascades - 1);
    scene_.shadows.distance_m = distance_m;
    EXPECT_OK(scene.set_params(params_));
    for (const auto& [elevation, azimuth] : {std::pair{90.0F, 0.0F}, {33.0F, 217.0F}, {5.0F, 122.0F}}) {
      scene_.sun.elevation_deg = elevation;
      scene_.sun.azimuth_deg = azimuth;
      for (const auto& [yaw, pitch] : {std::pair{azimuth + 160.0F, -12.0F}, {235.0F, 18.0F}}) {
        scene_.camera.position_m = {3.0, floor_m_ + 2.0, 2.0};
        scene_.camera.yaw_deg = yaw;
        scene_.camera.pitch_deg = pitch;
        EXPECT_OK(scene.set_scene(scene_));
        EXPECT_OK(scene.render(0.0));
        Result<image::Image> radiance = scene.radiance();
        EXPECT_OK(radiance);
        if (!radiance.ok()) return;
        const std::vector<float>& rgb = radiance.value().rgb;
        EXPECT_EQ(*std::max_element(rgb.begin(), rgb.end()), 0.0F)
            << what << ", " << cascades << " cascades to " << distance_m << " m, sun at " << elevation << ", yaw "
            << yaw << ", " << std::count_if(rgb.begin(), rgb.end(), [](float v) { return v > 0.0F; }) << " values";
      }
    }
  }

  Params params_;
  SceneParams scene_;
  std::string path_;
  double floor_m_ = 0.0;
};

TEST_F(GpuClosedRoom, SurfacesAreDarkOnBareGround) {
  params_.scattering.enabled = false;
  Scene* const scene = make("none", 0.1F);
  ASSERT_NE(scene, nullptr);
  for (const std::uint32_t cascades : {1U, 2U, 4U}) {
    for (const float distance_m : {10.0F, 3.0e5F}) expect_dark(*scene, cascades, distance_m, "surfaces");
  }
}

TEST_F(GpuClosedRoom, InscatteringIsDarkOnBareGround) {
  params_.scattering.medium = MediumKind::homogeneous;
  params_.homogeneous_medium.density = 300.0F;
  Scene* const scene = make("none", 0.4F);
  ASSERT_NE(scene, nullptr);
  for (const Technique technique : {Technique::brute_force, Technique::epipolar}) {
    params_.scattering.technique = technique;
    for (const std::uint32_t cascades : {1U, 4U}) {
      expect_dark(*scene, cascades, 60.0F, technique == Technique::epipolar ? "epipolar" : "brute force");
    }
  }
}

TEST_F(GpuClosedRoom, SurfacesAndInscatteringAreDarkOnTerrain) {
  params_.scattering.multiple = MultipleScattering::none;  // unoccluded by default
  Scene* const scene = make("procedural", 0.4F);
  ASSERT_NE(scene, nullptr);
  expect_dark(*scene, 1, 60.0F, "terrain");
  expect_dark(*scene, 4, 3.0e5F, "terrain");
}

}  // namespace
}  // namespace tyndall::scene
