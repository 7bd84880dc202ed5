// The scene far from the origin of the world looks the same as at the origin, and the planet has ground everywhere.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include "gpu_test.hpp"
#include "image/metrics.hpp"
#include "scene/description/map_projection.hpp"
#include "shared_scene.hpp"

namespace tyndall::scene {
namespace {

constexpr double kRadius_m = 6.36e6;
constexpr double kDeg = 180.0 / std::numbers::pi;
constexpr VkExtent2D kExtent = {96, 54};

// A position on the planet, given by the path from the origin.
struct Place {
  const char* name;
  double arc_deg, azimuth_deg;

  [[nodiscard]] glm::dvec3 up() const {
    const double arc = arc_deg / kDeg;
    const double azimuth = azimuth_deg / kDeg;
    return {std::sin(arc) * std::sin(azimuth), std::cos(arc), -std::sin(arc) * std::cos(azimuth)};
  }
  [[nodiscard]] glm::dvec3 at(double altitude_m) const {
    return glm::dvec3(0.0, -kRadius_m, 0.0) + up() * (kRadius_m + altitude_m);
  }
};

const Place kPlaces[] = {{"origin", 0.0, 0.0},
                         {"200 km", 1.8017, 60.0},
                         {"5000 km, between two map_projections", 45.0439, 90.0},
                         {"corner of three map_projections", 54.7356, 135.0},
                         {"east, where east is vertical", 90.0, 90.0},
                         {"north", 90.0, 0.0},
                         {"far side", 179.5, 20.0},
                         {"antipode", 180.0, 0.0}};

class GpuFarPlaces : public SharedSceneTest {
 protected:
  GpuFarPlaces() {
    params_.planet.radius_m = static_cast<float>(kRadius_m);
    params_.tables.size = {8, 32, 32, 4};
    params_.tables.orders = 1;
    scene_.shadows.resolution = 512;
    scene_.shadows.cascades = 2;
    scene_.shadows.first_marched = 0;
  }

  Scene* make(VkExtent2D extent = kExtent) { return shared_scene(extent, params_, scene_); }

  void stand(const glm::dvec3& at) { scene_.camera.position_m = {at.x, at.y, at.z}; }

  image::Image draw(Scene& scene) {
    EXPECT_OK(scene.set_scene(scene_));
    EXPECT_OK(scene.render(0.0));
    Result<image::Image> radiance = scene.radiance();
    EXPECT_OK(radiance);
    for (const float value : radiance.value().rgb) EXPECT_TRUE(std::isfinite(value) && value >= 0.0F);
    return std::move(radiance).value();
  }

  // Returns the depth of every pixel, row by row: near plane / distance along the view; 0 for the sky.
  std::vector<float> depths(Scene& scene) {
    draw(scene);
    const Result<std::vector<std::byte>> bytes =
        gpu::download(host(), scene.images().depth, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, 0, sizeof(float));
    EXPECT_OK(bytes);
    std::vector<float> out(bytes.value().size() / sizeof(float));
    std::memcpy(out.data(), bytes.value().data(), bytes.value().size());
    return out;
  }

  Params params_;
  SceneParams scene_;
};

// Draws the inside of the hall with light shafts, from a distance at which details are a few pixels wide: at the
// origin, and at other positions on the planet with the sun in the same local direction.
TEST_F(GpuFarPlaces, AMeshLooksTheSameWhereverItStands) {
  scene_.terrain.source = "none";
  scene_.meshes.source = "hall";
  scene_.shadows.distance_m = 60.0F;
  scene_.tonemap.auto_exposure = false;
  scene_.camera.pitch_deg = 4.0F;
  scene_.camera.yaw_deg = 30.0F;
  SunParams sun;
  sun.elevation_deg = 35.0F;
  sun.azimuth_deg = 120.0F;
  const glm::dvec3 sun_there = direction_to_sun(sun);
  const glm::dvec3 eye(0.6, 2.1, 1.7);  // east, up and south of the origin of the meshes
  Scene* scene = nullptr;
  image::Image first;
  for (const Technique technique : {Technique::brute_force, Technique::epipolar}) {
    params_.scattering.technique = technique;
    if (scene != nullptr) EXPECT_OK(scene->set_params(params_));
    for (const Place& place : {kPlaces[0], kPlaces[1], kPlaces[2], kPlaces[6]}) {
      const glm::dvec3 up = place.up();
      const glm::dvec3 east = east_of(up);
      const glm::dvec3 south = glm::cross(east, up);
      const glm::dvec2 map = map_from_world(place.at(0.0), kRadius_m);
      scene_.meshes.position_m = {map.x, 0.25, map.y};
      stand(place.at(0.25) + east * eye.x + up * eye.y + south * eye.z);
      const glm::dvec3 to_sun = east * sun_there.x + up * sun_there.y + south * sun_there.z;
      scene_.sun.elevation_deg = static_cast<float>(std::asin(std::clamp(to_sun.y, -1.0, 1.0)) * kDeg);
      scene_.sun.azimuth_deg = static_cast<float>(std::atan2(to_sun.x, -to_sun.z) * kDeg);
      if (scene == nullptr) scene = make();
      ASSERT_NE(scene, nullptr);
      EXPECT_OK(scene->set_scene(scene_));
      draw(*scene);
      Result<image::Image> display = scene->display();
      ASSERT_OK(display);
      if (place.arc_deg == 0.0) {
        first = std::move(display).value();
        continue;
      }
      // The texels of the shadow maps have other positions, and the angles of the sun are rounded.
      EXPECT_GT(image::compare(first, display.value()).psnr_db, 45.0)
          << place.name << (technique == Technique::epipolar ? ", epipolar" : "");
    }
  }
}

// Straight down, radiance does not depend on the height above the atmosphere. From far away, the terminator is as sharp
// with epipolar sampling as by brute force.
TEST_F(GpuFarPlaces, ThePlanetLooksTheSameFromAnyHeight) {
  scene_.terrain.source = "none";
  scene_.camera.pitch_deg = -90.0F;
  scene_.sun.elevation_deg = 60.0F;
  scene_.tonemap.auto_exposure = false;
  params_.tables.size = {16, 64, 32, 8};
  Scene* const scene = make();
  ASSERT_NE(scene, nullptr);
  const auto look = [&](double altitude_m, float fov_deg, Technique technique) {
    params_.scattering.technique = technique;
    EXPECT_OK(scene->set_params(params_));
    scene_.camera.fov_deg = fov_deg;
    stand({0.0, altitude_m, 0.0});
    return draw(*scene);
  };
  const std::size_t middle = 3 * (kExtent.height / 2 * kExtent.width + kExtent.width / 2);
  std::array<double, 3> first = {};
  for (const Technique technique : {Technique::brute_force, Technique::epipolar}) {
    for (const double altitude_m : {2e5, 1e6, 1e7, 3.5786e7}) {
      const image::Image picture = look(altitude_m, 1.0F, technique);
      for (std::size_t c = 0; c < 3; ++c) {
        const double radiance = static_cast<double>(picture.rgb[middle + c]);
        if (first[c] == 0.0) first[c] = radiance;
        EXPECT_NEAR(radiance, first[c], 0.02 * first[c]) << altitude_m << " channel " << c;
      }
    }
  }
  scene_.sun.elevation_deg = 0.0F;
  for (const auto& [altitude_m, fov_deg] : {std::pair(1e7, 53.0F), std::pair(3.5786e7, 20.0F)}) {
    look(altitude_m, fov_deg, Technique::brute_force);
    const Result<image::Image> reference = scene->display();
    look(altitude_m, fov_deg, Technique::epipolar);
    const Result<image::Image> picture = scene->display();
    ASSERT_OK(reference);
    ASSERT_OK(picture);
    EXPECT_GT(image::compare(picture.value(), reference.value()).psnr_db, 38.0) << altitude_m;
  }
}

// What cannot be drawn well is noted.
TEST_F(GpuFarPlaces, LimitsAreNoted) {
  scene_.terrain.source = "none";
  params_.scattering.technique = Technique::brute_force;
  Scene* const scene = make();
  ASSERT_NE(scene, nullptr);
  const auto noted = [&](const char* part) {
    draw(*scene);
    return std::any_of(scene->notes().begin(), scene->notes().end(),
                       [&](const std::string& note) { return note.find(part) != std::string::npos; });
  };
  stand({0.0, 2.0, 0.0});
  scene_.camera.fov_deg = 100.0F;
  EXPECT_FALSE(noted("within the near plane"));
  scene_.camera.fov_deg = 170.0F;
  EXPECT_TRUE(noted("within the near plane"));
  stand({0.0, 1e8, 0.0});
  EXPECT_FALSE(noted("single precision"));
  stand({0.0, 1e9, 0.0});
  EXPECT_TRUE(noted("single precision"));
}

// The ground drawn below the camera has the height that ground_height() returns, and the camera is not raised.
TEST_F(GpuFarPlaces, TheGroundIsDrawnWhereTheCameraStands) {
  params_.scattering.enabled = false;
  scene_.camera.pitch_deg = -90.0F;
  Scene* const scene = make();
  ASSERT_NE(scene, nullptr);
  for (const Place& place : {kPlaces[1], kPlaces[2], kPlaces[3], kPlaces[4], kPlaces[7]}) {
    const double ground_m = ground_height(*scene->elevations(), place.up(), kRadius_m);
    stand(place.at(ground_m + 60.0));
    const std::vector<float> depth = depths(*scene);
    // Four pixels meet below the camera. Cells are 4 m wide, and slopes are steep.
    const std::size_t middle = kExtent.height / 2 * kExtent.width + kExtent.width / 2;
    const double distance_m = kNearPlane_m / static_cast<double>(depth[middle]);
    EXPECT_NEAR(distance_m, 60.0, 2.0) << place.name;
    EXPECT_NEAR(altitude_of(scene->images().view.position, kRadius_m), ground_m + 60.0, 1e-3) << place.name;
  }
}

// Level views from above all summits show sky in the upper rows, and only ground below the horizon.
TEST_F(GpuFarPlaces, ThereIsAHorizonAllAround) {
  params_.scattering.enabled = false;
  scene_.camera.pitch_deg = 0.0F;
  scene_.camera.fov_deg = 60.0F;
  Scene* const scene = make();
  ASSERT_NE(scene, nullptr);
  for (const Place& place : {kPlaces[2], kPlaces[3], kPlaces[4], kPlaces[7]}) {
    stand(place.at(6000.0));
    for (const float yaw_deg : {0.0F, 90.0F, 180.0F, 270.0F}) {
      scene_.camera.yaw_deg = yaw_deg;
      const std::vector<float> depth = depths(*scene);
      std::size_t wrong = 0;
      for (std::size_t x = 0; x < kExtent.width; ++x) {
        // The horizon is 2.5 degrees, or 2.4 rows, below the middle. Summits exceed it by less than a row.
        for (std::size_t y = 0; y < kExtent.height; ++y) {
          const bool ground = depth[y * kExtent.width + x] > 0.0F;
          if (y < kExtent.height / 2 - 2) wrong += ground ? 1 : 0;
          if (y > kExtent.height / 2 + 3) wrong += ground ? 0 : 1;
        }
      }
      EXPECT_EQ(wrong, 0U) << place.name << ", yaw " << yaw_deg;
    }
  }
}

// From high above, every ray that hits the sphere at sea level hits ground in front of it.
TEST_F(GpuFarPlaces, TheTerrainHasNoEndFromSpace) {
  params_.scattering.enabled = false;
  Scene* const scene = make();
  ASSERT_NE(scene, nullptr);
  for (const Place& place : {kPlaces[0], kPlaces[3], kPlaces[6], kPlaces[7]}) {
    for (const double altitude_m : {1.0e6, 8.0e6}) {
      stand(place.at(altitude_m));
      scene_.camera.pitch_deg = altitude_m > 2.0e6 ? -90.0F : -45.0F;
      const std::vector<float> depth = depths(*scene);
      const View& view = scene->images().view;
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < depth.size(); ++i) {
        const double x = 2.0 * (static_cast<double>(i % kExtent.width) + 0.5) / kExtent.width - 1.0;
        const double y = 1.0 - 2.0 * (static_cast<double>(i / kExtent.width) + 0.5) / kExtent.height;
        const glm::dvec3 ray =
            view.forward + view.right * (x * view.tan_half_width) + view.up * (y * view.tan_half_height);
        const double length = glm::length(ray);
        const glm::dvec3 from_centre = view.position + glm::dvec3(0.0, kRadius_m, 0.0);
        const double nearest_m = glm::length(glm::cross(from_centre, ray)) / length;  // distance to the planet's centre
        if (depth[i] <= 0.0F) {
          // The coarsest cells are flat, and their middles are a few hundred metres too low.
          wrong += nearest_m < kRadius_m - 2000.0 ? 1 : 0;
          continue;
        }
        const double drawn_m =
            altitude_of(view.position + ray * (kNearPlane_m / static_cast<double>(depth[i])), kRadius_m);
        wrong += drawn_m < -1500.0 || drawn_m > 5200.0 ? 1 : 0;
      }
      EXPECT_EQ(wrong, 0U) << place.name << " from " << altitude_m << " m";
    }
  }
}

// If a model draws a sphere instead of terrain, the camera is only limited by the sphere.
TEST_F(GpuFarPlaces, TheSphereOfOneilsModelIsTheGround) {
  scene_.scattering.model = ScatteringModel::oneil;
  scene_.oneil.ground = OneilGround::sphere;
  stand({0.0, 100.0, 0.0});
  Scene* const scene = make();
  ASSERT_NE(scene, nullptr);
  draw(*scene);
  EXPECT_NEAR(scene->images().view.position.y, 100.0, 1e-9);
  EXPECT_EQ(scene->elevations(), nullptr);
  scene_.oneil.ground = OneilGround::terrain;
  draw(*scene);
  EXPECT_GT(scene->images().view.position.y, 300.0);
  EXPECT_NE(scene->elevations(), nullptr);
}

}  // namespace
}  // namespace tyndall::scene
