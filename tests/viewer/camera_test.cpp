// Control of camera and sun by mouse and keys, without a window: pure functions compared with geometry.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/description/map_projection.hpp"
#include "scene/view/camera.hpp"
#include "viewer/camera_control.hpp"

namespace tyndall::viewer {
namespace {

constexpr double kRadius_m = 6.36e6;

CameraState camera_at(double altitude_m, double yaw_deg = 30.0, double pitch_deg = -10.0) {
  return {scene::world_from_map(2000.0, -3000.0, altitude_m, kRadius_m), yaw_deg, pitch_deg, 45.0};
}

scene::View view_of(const CameraState& camera) {
  scene::CameraParams params;
  camera_to_params(camera, params);
  return scene::view_from_params(params, 1.0, kRadius_m);
}

TEST(ViewerCamera, FliesAlongItsDirections) {
  const CameraState camera = camera_at(5000.0);
  const scene::View view = view_of(camera);
  const auto way = [&](const Motion& motion) {
    return moved(camera, motion, 0.5, 20.0, kRadius_m).position - camera.position;
  };
  // Over 10 m, the curvature of the planet is below a millimetre.
  EXPECT_LT(glm::length(way({.forward = 1.0}) - 10.0 * view.forward), 2.0e-3);
  EXPECT_LT(glm::length(way({.forward = -1.0}) + 10.0 * view.forward), 2.0e-3);
  EXPECT_LT(glm::length(way({.right = 1.0}) - 10.0 * view.right), 2.0e-3);
  EXPECT_LT(glm::length(way({.up = 1.0}) - 10.0 * scene::up_of(camera.position, kRadius_m)), 2.0e-3);
  EXPECT_NEAR(glm::length(way({.right = 1.0, .forward = 1.0})), 10.0, 2.0e-3);  // not faster diagonally
  EXPECT_FALSE(Motion{}.any());
}

TEST(ViewerCamera, SpeedGrowsWithHeightAndShift) {
  EXPECT_GT(flight_speed(0.0, false), 0.0);
  EXPECT_GT(flight_speed(1000.0, false), flight_speed(10.0, false));
  EXPECT_GT(flight_speed(10.0, true), 3.0 * flight_speed(10.0, false));
  EXPECT_EQ(flight_speed(-5.0, false), flight_speed(0.0, false));
  // The flight from the ground to orbit takes less than a minute.
  double height_m = 2.0;
  double seconds = 0.0;
  for (; height_m < 400.0e3; seconds += 0.1) height_m += 0.1 * flight_speed(height_m, false);
  EXPECT_LT(seconds, 60.0);
}

// Around the whole planet, the direction of view has a constant angle to the horizon, no step rotates the view by more
// than the planet's curvature, and the great circle closes.
TEST(ViewerCamera, GoesAroundThePlanetWithoutAJump) {
  CameraState camera = camera_at(10000.0, 77.0, 0.0);
  const CameraState start = camera;
  constexpr int kSteps = 4000;
  const double step_m = 2.0 * 3.141592653589793 * (kRadius_m + 10000.0) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const scene::View before = view_of(camera);
    camera = moved(camera, {.forward = 1.0}, 1.0, step_m, kRadius_m);
    const scene::View after = view_of(camera);
    ASSERT_NEAR(scene::altitude_of(camera.position, kRadius_m), 10000.0, 1.0);
    ASSERT_EQ(camera.pitch_deg, 0.0);
    // A step is 2 pi / 4000 of the planet. The rest is the rounding of parameters to single precision.
    ASSERT_LT(glm::length(after.forward - before.forward), 1.1 * 6.2832 / kSteps) << i;
    ASSERT_LT(glm::length(after.right - before.right), 0.1 * 6.2832 / kSteps) << i;
  }
  EXPECT_LT(glm::distance(camera.position, start.position), 2.0e-3 * kRadius_m);
}

TEST(ViewerCamera, ClimbsFromTheGroundToOrbitWithoutAJump) {
  CameraState camera = camera_at(2.0, 200.0, 20.0);
  double last_m = 2.0;
  for (int i = 0; i < 3000; ++i) {
    const double height_m = scene::altitude_of(camera.position, kRadius_m);
    camera = moved(camera, {.up = 1.0}, 0.02, flight_speed(height_m, false), kRadius_m);
    const double now_m = scene::altitude_of(camera.position, kRadius_m);
    ASSERT_GT(now_m, last_m);
    ASSERT_LT(now_m - last_m, 1.0 + 0.02 * last_m);
    last_m = now_m;
    ASSERT_NEAR(camera.yaw_deg, 200.0, 1.0e-6);
  }
  EXPECT_GT(last_m, 400.0e3);
}

TEST(ViewerCamera, StaysAboveTheGroundAndBelowTheSky) {
  const CameraState low = above_ground(camera_at(100.0), 1500.0, kRadius_m);
  EXPECT_NEAR(scene::altitude_of(low.position, kRadius_m), 1500.0 + kMinHeight_m, 1.0e-3);
  const CameraState high = above_ground(camera_at(1.0e9), 0.0, kRadius_m);
  EXPECT_NEAR(scene::altitude_of(high.position, kRadius_m), kMaxAltitude_m, 1.0);
  const CameraState free = camera_at(3000.0);
  EXPECT_EQ(above_ground(free, 1500.0, kRadius_m).position, free.position);
}

TEST(ViewerCamera, LooksWhereTheDragPullsIt) {
  const CameraState camera = camera_at(1000.0, 10.0, 0.0);
  const CameraState right = turned(camera, 100.0, 0.0, 500.0);  // the picture follows the pointer
  EXPECT_NEAR(right.yaw_deg, 10.0 - 100.0 * 45.0 / 500.0, 1.0e-9);
  EXPECT_EQ(right.pitch_deg, 0.0);
  EXPECT_NEAR(turned(camera, 0.0, 50.0, 500.0).pitch_deg, 4.5, 1.0e-9);
  EXPECT_EQ(turned(camera, 0.0, 1.0e6, 500.0).pitch_deg, kMaxPitch_deg);
  EXPECT_EQ(turned(camera, 0.0, -1.0e6, 500.0).pitch_deg, -kMaxPitch_deg);
  EXPECT_GE(turned(camera, 1000.0, 0.0, 500.0).yaw_deg, 0.0);
  EXPECT_LT(zoomed(camera, 3.0).fov_deg, 45.0);
  EXPECT_EQ(zoomed(camera, 1000.0).fov_deg, kFovRange_deg[0]);
  EXPECT_EQ(zoomed(camera, -1000.0).fov_deg, kFovRange_deg[1]);
}

TEST(ViewerCamera, TurnsTheSun) {
  scene::SunParams sun;
  sun.azimuth_deg = 350.0F;
  sun.elevation_deg = 5.0F;
  const scene::SunParams turned_sun = sun_turned(sun, 100.0, -50.0, 900.0);
  EXPECT_NEAR(turned_sun.azimuth_deg, 10.0, 1.0e-3);
  EXPECT_NEAR(turned_sun.elevation_deg, 15.0, 1.0e-3);
  EXPECT_EQ(sun_turned(sun, 0.0, -1.0e6, 900.0).elevation_deg, 90.0F);
  EXPECT_EQ(sun_turned(sun, 0.0, 1.0e6, 900.0).elevation_deg, -90.0F);
  EXPECT_EQ(turned_sun.irradiance, sun.irradiance);
}

TEST(ViewerCamera, GoesThroughParametersAndBack) {
  scene::CameraParams params;
  params.altitude_m = 1234.0F;
  const CameraState camera = camera_from_params(params, kRadius_m);
  EXPECT_NEAR(scene::altitude_of(camera.position, kRadius_m), 1234.0, 1.0);
  scene::CameraParams back;
  camera_to_params(camera, back);
  EXPECT_EQ(back.altitude_m, -1.0F);
  EXPECT_NEAR(back.position_m.y, 1234.0F, 1.0F);
  EXPECT_EQ(back.yaw_deg, params.yaw_deg);
}

}  // namespace
}  // namespace tyndall::viewer
