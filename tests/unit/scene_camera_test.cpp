// The projection of the map onto the planet, and camera and sun above it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "scene/description/map_projection.hpp"
#include "scene/terrain/terrain.hpp"
#include "scene/view/camera.hpp"
#include "scene/view/local_frame.hpp"

namespace tyndall::scene {
namespace {

constexpr double kRadius_m = 6.36e6;
constexpr double kRad = 0.017453292519943295;
constexpr double kPi = std::numbers::pi;

TEST(SceneMapProjection, MapAndWorldAreInverse) {
  for (const double distance : {0.0, 1e-3, 1.0, 1e4, 1e6, 1.5e7}) {
    for (const double angle : {0.0, 0.7, 2.9, 4.0, 6.0}) {
      for (const double altitude : {-400.0, 0.0, 8848.0, 4e5}) {
        const double x = distance * std::cos(angle);
        const double z = distance * std::sin(angle);
        const glm::dvec3 p = world_from_map(x, z, altitude, kRadius_m);
        // At planetary distances, double precision resolves micrometres.
        EXPECT_NEAR(altitude_of(p, kRadius_m), altitude, 1e-6);
        const glm::dvec2 map = map_from_world(p, kRadius_m);
        EXPECT_NEAR(map.x, x, 1e-6);
        EXPECT_NEAR(map.y, z, 1e-6);
        EXPECT_NEAR(glm::dot(up_of(p, kRadius_m), glm::normalize(p + glm::dvec3(0, kRadius_m, 0))), 1.0, 1e-12);
      }
    }
  }
  // Azimuthal equidistant: a quarter of the circumference away the vertical is horizontal.
  const glm::dvec3 quarter = world_from_map(0.5 * 3.141592653589793 * kRadius_m, 0.0, 0.0, kRadius_m);
  EXPECT_NEAR(quarter.x, kRadius_m, 1e-6);
  EXPECT_NEAR(quarter.y, -kRadius_m, 1e-6);
}

// Every position of the planet is near the centre of a map projection. The weights of projections add up to one and
// change slowly.
TEST(SceneMapProjection, MapProjectionsCoverThePlanet) {
  std::mt19937 random(5);
  std::normal_distribution<double> any;
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec3 up = glm::normalize(glm::dvec3(any(random), any(random), any(random)));
    const int nearest = nearest_projection(up);
    EXPECT_GE(glm::dot(projection_frame(nearest)[1], up), std::sqrt(1.0 / 3.0) - 1e-12);
    const std::array<double, kMapProjectionCount> weights = projection_weights(up);
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-12);
    EXPECT_EQ(static_cast<int>(std::max_element(weights.begin(), weights.end()) - weights.begin()), nearest);
    const glm::dvec3 aside = glm::normalize(up + 1e-4 * glm::dvec3(any(random), any(random), any(random)));
    const std::array<double, kMapProjectionCount> beside = projection_weights(aside);
    for (int projection = 0; projection < kMapProjectionCount; ++projection) {
      const auto index = static_cast<std::size_t>(projection);
      EXPECT_NEAR(beside[index], weights[index], 0.02) << projection;
      const glm::dvec2 map = projection_from_up(projection, up, kRadius_m);
      const glm::dvec3 back = world_from_projection(projection, map.x, map.y, 1000.0, kRadius_m);
      EXPECT_NEAR(glm::distance(back, glm::dvec3(0, -kRadius_m, 0) + up * (kRadius_m + 1000.0)), 0.0, 1e-5)
          << projection;
    }
  }
  for (int projection = 0; projection < kMapProjectionCount; ++projection) {
    const glm::dmat3& frame = projection_frame(projection);
    EXPECT_EQ(glm::cross(frame[0], frame[1]), frame[2]) << projection;  // right-handed like the world
  }
}

// Elevation has no step at the seams of map projections: from the origin over a corner of three of them to the
// antipode.
TEST(SceneMapProjection, TheGroundHasNoSteps) {
  const Result<ElevationSource> source = ElevationSource::create({});
  ASSERT_TRUE(source.ok());
  const double corner = std::acos(std::sqrt(1.0 / 3.0));
  for (const double middle : {0.25 * kPi, corner, 0.75 * kPi, kPi}) {
    for (int i = -100; i <= 100; ++i) {
      const auto ground_m = [&](double way_m) {
        const double arc = middle + way_m / kRadius_m;
        const double azimuth = middle == corner ? 0.25 * kPi : 0.0;
        const glm::dvec3 up(std::sin(arc) * std::cos(azimuth), std::cos(arc), std::sin(arc) * std::sin(azimuth));
        return ground_height(source.value(), up, kRadius_m);
      };
      const double way_m = 5000.0 * i;
      EXPECT_LT(std::abs(ground_m(way_m + 4.0) - ground_m(way_m)), 12.0) << middle << " " << way_m;
    }
  }
}

TEST(SceneLocalFrame, IsBelowTheCameraAndRightHanded) {
  for (const glm::dvec3& up : {glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0),
                               glm::normalize(glm::dvec3(0.3, 0.7, -0.2)), glm::normalize(glm::dvec3(-1, -1, 1))}) {
    const glm::dvec3 eye = glm::dvec3(0, -kRadius_m, 0) + up * (kRadius_m + 5000.0);
    const LocalFrame frame = local_frame(eye, kRadius_m);
    const glm::dvec3 place = frame.place(eye);
    EXPECT_LT(std::hypot(place.x, place.z), 800.0);
    EXPECT_NEAR(place.y, 5000.0, 1.0);
    EXPECT_NEAR(glm::distance(frame.place({0.0, -kRadius_m, 0.0}), glm::dvec3(0.0, -kRadius_m, 0.0)), 0.0, 1e-6);
    EXPECT_NEAR(
        glm::distance(glm::cross(frame.direction({1, 0, 0}), frame.direction({0, 1, 0})), frame.direction({0, 0, 1})),
        0.0, 1e-12);
  }
  const LocalFrame near = local_frame({300.0, 2.0, -400.0}, kRadius_m);
  EXPECT_EQ(near.world_from_local, glm::dmat4(1.0));
}

// East is vertical at two points of the equator, and the map has no direction at the antipode; both must be handled.
TEST(SceneCamera, StandsAnywhere) {
  CameraParams params;
  for (const DVec3& at :
       {DVec3(kRadius_m, -kRadius_m, 0.0), DVec3(-kRadius_m, -kRadius_m, 0.0), DVec3(0.0, -2.0 * kRadius_m, 0.0),
        DVec3(0.0, -kRadius_m, kRadius_m), DVec3(0.0, -kRadius_m, 0.0)}) {
    params.position_m = at;
    params.altitude_m = 1500.0F;
    const View view = view_from_params(params, 1.5, kRadius_m);
    EXPECT_NEAR(altitude_of(view.position, kRadius_m), 1500.0, 1e-6);
    EXPECT_NEAR(glm::length(view.forward), 1.0, 1e-12);
    EXPECT_NEAR(glm::distance(glm::cross(view.right, view.up), -view.forward), 0.0, 1e-12);
    if (at != DVec3(0.0, -kRadius_m, 0.0)) {
      EXPECT_LT(glm::distance(view.position, to_glm(at)), 1501.0);  // and not at the origin
    }
  }
}

TEST(SceneCamera, LooksWhereYawAndPitchSay) {
  CameraParams params;
  params.position_m = {0.0F, 100.0F, 0.0F};
  const struct {
    float yaw, pitch;
    glm::dvec3 forward;
  } cases[] = {{0, 0, {0, 0, -1}}, {90, 0, {1, 0, 0}}, {180, 0, {0, 0, 1}}, {0, 90, {0, 1, 0}}, {-90, -90, {0, -1, 0}}};
  for (const auto& c : cases) {
    params.yaw_deg = c.yaw;
    params.pitch_deg = c.pitch;
    const View view = view_from_params(params, 1.5, kRadius_m);
    EXPECT_NEAR(glm::distance(view.forward, c.forward), 0.0, 1e-6) << c.yaw << " " << c.pitch;
    EXPECT_NEAR(glm::distance(glm::cross(view.right, view.up), -view.forward), 0.0, 1e-12);  // right-handed
    EXPECT_NEAR(view.tan_half_width, 1.5 * view.tan_half_height, 1e-12);
    EXPECT_NEAR(view.tan_half_height, std::tan(0.5 * params.fov_deg * kRad), 1e-6);
  }
  // Far from the origin, the local horizon is used, and altitude_m only replaces the altitude.
  params.position_m = {3.0e6F, -500.0F, 1.0e6F};
  params.altitude_m = 1234.0F;
  params.pitch_deg = 0.0F;
  const View away = view_from_params(params, 1.0, kRadius_m);
  EXPECT_NEAR(altitude_of(away.position, kRadius_m), 1234.0, 1e-3);
  EXPECT_NEAR(glm::dot(away.forward, up_of(away.position, kRadius_m)), 0.0, 1e-12);
}

TEST(SceneCamera, DepthIsReversedWithAnInfiniteFarPlane) {
  CameraParams params;
  params.position_m = {4000.0F, 2500.0F, -800.0F};
  params.yaw_deg = 33.0F;
  params.pitch_deg = -21.0F;
  const View view = view_from_params(params, 16.0 / 9.0, kRadius_m);
  const glm::dmat4 clip_from_world_matrix = clip_from_world(view);
  const auto ndc = [&](double depth, double right, double up) {
    const glm::dvec3 p = view.position + view.forward * depth + view.right * (right * view.tan_half_width * depth) +
                         view.up * (up * view.tan_half_height * depth);
    const glm::dvec4 clip = clip_from_world_matrix * glm::dvec4(p, 1.0);
    return glm::dvec3(clip) / clip.w;
  };
  EXPECT_NEAR(ndc(kNearPlane_m, 0, 0).z, 1.0, 1e-9);
  for (const double depth : {1.0, 100.0, 1e5, 1e8}) {
    EXPECT_NEAR(ndc(depth, 0, 0).z * depth, kNearPlane_m, 1e-6) << depth;
    // x points right and y down, as in Vulkan.
    EXPECT_NEAR(glm::distance(glm::dvec2(ndc(depth, 0.5, 0.25)), glm::dvec2(0.5, -0.25)), 0.0, 1e-6) << depth;
  }
  // The public structure has the same values, rounded to single precision.
  const Camera camera = camera_from_view(view);
  EXPECT_EQ(camera.world_from_view.m[12], 4000.0F);
  EXPECT_EQ(camera.clip_from_view.m[11], -1.0F);
  EXPECT_EQ(camera.clip_from_view.m[10], 0.0F);
  EXPECT_EQ(camera.clip_from_view.m[14], static_cast<float>(kNearPlane_m));
}

TEST(SceneCamera, TheSunStandsAtItsAngles) {
  SunParams sun;
  sun.elevation_deg = 30.0F;
  sun.azimuth_deg = 90.0F;
  EXPECT_NEAR(glm::distance(direction_to_sun(sun), glm::dvec3(std::sqrt(0.75), 0.5, 0.0)), 0.0, 1e-7);
  sun.azimuth_deg = 0.0F;
  EXPECT_NEAR(direction_to_sun(sun).z, -std::sqrt(0.75), 1e-7);  // north
  // The sun does not move unless animated; then it rotates at its speed about the axis (0.5, 0.3, 0).
  EXPECT_EQ(animated_direction_to_sun(sun, 100.0), direction_to_sun(sun));
  sun.animate = true;
  sun.animate_speed_deg = 10.0F;
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.5, 0.3, 0.0));
  const glm::dvec3 start = direction_to_sun(sun);
  const glm::dvec3 later = animated_direction_to_sun(sun, 9.0);  // a quarter turn
  EXPECT_NEAR(glm::length(later), 1.0, 1e-12);
  EXPECT_NEAR(glm::dot(later, axis), glm::dot(start, axis), 1e-12);
  const glm::dvec3 a = start - axis * glm::dot(start, axis);
  const glm::dvec3 b = later - axis * glm::dot(later, axis);
  EXPECT_NEAR(glm::dot(a, b), 0.0, 1e-7);
}

}  // namespace
}  // namespace tyndall::scene
