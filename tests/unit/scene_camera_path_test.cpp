// The flight of the camera: through its keyframes, smooth between them, turning the shorter way, along the planet's
// curve, and from the ground to orbit without a jump or a dive.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/description/camera_path.hpp"

#include "scene/description/map_projection.hpp"
#include "scene/description/placed_sun.hpp"

namespace tyndall::scene {
namespace {

constexpr double kRadius_m = 6.36e6;

PathFrame frame(double time_s) {
  PathFrame out;
  out.time_s = time_s;
  return out;
}

SceneParams at(const CameraPath& path, double seconds, const SceneParams& base = {}) {
  return pose_at(path, seconds, base, kRadius_m);
}

glm::dvec3 place(const SceneParams& scene) {
  const DVec3& p = scene.camera.position_m;
  return {p.x, p.y, p.z};
}

double altitude(const SceneParams& scene) { return altitude_of(place(scene), kRadius_m); }

CameraPath from_valley_to_orbit() {
  CameraPath path;
  for (int i = 0; i < 5; ++i) path.frames.push_back(frame(10.0 * i * (i + 1) / 2));
  path.frames[0].position_m = DVec3(-15000.0, 1500.0, -15000.0);
  path.frames[1].position_m = DVec3(-12000.0, 1800.0, -16000.0);
  path.frames[2].position_m = DVec3(0.0, 30000.0, 0.0);
  path.frames[4].position_m = DVec3(3.0e6, 2.0e6, -2.0e6);
  path.frames[0].yaw_deg = 350.0F;
  path.frames[2].yaw_deg = 20.0F;
  path.frames[3].yaw_deg = 300.0F;
  path.frames[1].sun_elevation_deg = -4.0F;
  path.frames[4].sun_elevation_deg = 30.0F;
  return path;
}

TEST(ScenePath, WithoutFramesNothingChanges) {
  SceneParams base;
  base.camera.yaw_deg = 17.0F;
  base.sun.animate = true;
  const SceneParams out = at({}, 5.0, base);
  EXPECT_EQ(out.camera.yaw_deg, 17.0F);
  EXPECT_EQ(place(out), place(base));
  EXPECT_EQ(out.sun.animate, true);
}

TEST(ScenePath, PassesThroughItsFramesAndPreservesOtherParameters) {
  const CameraPath path = from_valley_to_orbit();
  SceneParams base;
  base.camera.pitch_deg = -7.0F;
  base.sun.azimuth_deg = 33.0F;
  for (const PathFrame& key : path.frames) {
    const SceneParams now = at(path, key.time_s, base);
    EXPECT_EQ(now.camera.pitch_deg, -7.0F);
    EXPECT_EQ(now.sun.azimuth_deg, 33.0F);
    EXPECT_EQ(now.camera.fov_deg, base.camera.fov_deg);
    if (key.position_m) {
      const glm::dvec3 wanted = {key.position_m->x, key.position_m->y, key.position_m->z};
      EXPECT_LT(glm::length(place(now) - wanted), 1e-6);
      EXPECT_NEAR(altitude(now), altitude_of(wanted, kRadius_m), 1e-6 * std::abs(altitude_of(wanted, kRadius_m)));
    }
    EXPECT_NEAR(now.camera.yaw_deg, key.yaw_deg.value_or(now.camera.yaw_deg), 1e-4F);
    EXPECT_NEAR(now.sun.elevation_deg, key.sun_elevation_deg.value_or(now.sun.elevation_deg), 1e-5F);
  }
  // The camera rests before the first and after the last frame.
  EXPECT_EQ(place(at(path, -3.0)), place(at(path, 0.0)));
  EXPECT_EQ(place(at(path, 1e5)), place(at(path, 100.0)));
  EXPECT_EQ(at(path, 0.0, base).sun.elevation_deg, -4.0F);  // until the first frame that sets it
}

// Compares the speed just before and just after each time. If the speed is continuous, the difference halves when the
// step is halved. At a jump of the speed, it would not change.
TEST(ScenePath, PositionAndAnglesChangeSmoothly) {
  const CameraPath path = from_valley_to_orbit();
  const auto value = [&](double t, int which) {
    const SceneParams now = at(path, t);
    if (which == 0) return std::asinh(altitude(now) / 1000.0);
    if (which == 1) return static_cast<double>(now.sun.elevation_deg);
    if (which == 2) return place(now).x / 1.0e5;
    const double yaw = static_cast<double>(now.camera.yaw_deg);
    return yaw > 180.0 ? yaw - 360.0 : yaw;
  };
  for (int which = 0; which < 4; ++which) {
    for (double key = 10.0; key < 100.0; key += 0.5) {  // includes all frames
      const auto kink = [&](double step) {
        return std::abs((value(key + step, which) - value(key, which)) -
                        (value(key, which) - value(key - step, which))) /
               step;
      };
      // Relative to changes of 30 degrees and 6 units of altitude in at least 10 s.
      ASSERT_LT(kink(0.05), 0.25) << which << " at " << key;
      ASSERT_LT(kink(0.025), 0.6 * kink(0.05) + 0.02) << which << " at " << key;
    }
  }
}

TEST(ScenePath, NeverBelowOrAboveItsFrames) {
  CameraPath path;
  const float altitudes_m[] = {1500.0F, 1500.0F, 1600.0F, 400000.0F, 400000.0F};
  for (int i = 0; i < 5; ++i) {
    path.frames.push_back(frame(i == 4 ? 100.0 : 5.0 * i));
    path.frames.back().altitude_m = altitudes_m[i];
  }
  double before = 0.0;
  for (double t = 0.0; t <= 110.0; t += 0.05) {
    const double now = altitude(at(path, t));
    ASSERT_GE(now, 1499.99);
    ASSERT_LE(now, 400001.0);
    ASSERT_GE(now, before * (1.0 - 1e-6)) << t;
    before = now;
  }
  // In the middle of the ascent it is much nearer to the ground than to orbit.
  EXPECT_LT(altitude(at(path, 12.5)), 40000.0);
  // The position above the planet is that of the parameters.
  EXPECT_NEAR(place(at(path, 3.0)).x, 0.0, 1e-3);
}

TEST(ScenePath, TurnsTheShortWay) {
  CameraPath path;
  path.frames = {frame(0.0), frame(10.0), frame(20.0)};
  path.frames[0].yaw_deg = 350.0F;
  path.frames[1].yaw_deg = 10.0F;
  path.frames[2].yaw_deg = -190.0F;  // 170
  path.frames[0].sun_azimuth_deg = 5.0F;
  path.frames[2].sun_azimuth_deg = 355.0F;
  for (double t = 0.0; t <= 20.0; t += 0.25) {
    const double yaw = static_cast<double>(at(path, t).camera.yaw_deg);
    EXPECT_TRUE(yaw >= 0.0 && yaw < 360.0);
    EXPECT_TRUE(t < 10.0 ? yaw >= 349.99 || yaw <= 10.01 : yaw >= 9.99 && yaw <= 170.01) << t << " " << yaw;
    const double azimuth = static_cast<double>(at(path, t).sun.azimuth_deg);
    EXPECT_TRUE(azimuth >= 354.99 || azimuth <= 5.01) << azimuth;
  }
}

TEST(ScenePath, FollowsTheCurveOfThePlanet) {
  CameraPath path;
  path.frames = {frame(0.0), frame(10.0)};
  path.frames[0].position_m = DVec3(0.0, 100.0, 0.0);
  // A quarter of the way around the planet, 100 m above it.
  path.frames[1].position_m = DVec3((kRadius_m + 100.0), (-kRadius_m), 0.0);
  for (double t = 0.0; t <= 10.0; t += 0.1) {
    const SceneParams now = at(path, t);
    EXPECT_NEAR(altitude(now), 100.0, 0.6) << t;  // single precision of positions
    EXPECT_NEAR(altitude_of(place(now), kRadius_m), 100.0, 0.6) << t;
  }
  EXPECT_NEAR(place(at(path, 5.0)).x, (kRadius_m + 100.0) * std::sqrt(0.5), 1.0);
}

TEST(ScenePath, LoopsWithoutASeam) {
  CameraPath path;
  path.loop = true;
  path.frames = {frame(2.0), frame(5.0), frame(9.0), frame(14.0)};
  for (int i = 0; i < 3; ++i) {
    path.frames[static_cast<std::size_t>(i)].yaw_deg = 120.0F * static_cast<float>(i);
    path.frames[static_cast<std::size_t>(i)].altitude_m = 1000.0F + 500.0F * static_cast<float>(i % 2);
  }
  path.frames[1].fov_deg = 30.0F;
  for (const double t : {2.0, 3.3, 7.0, 13.9}) {
    EXPECT_NEAR(at(path, t).camera.yaw_deg, at(path, t + 12.0).camera.yaw_deg, 1e-3F);
    EXPECT_NEAR(at(path, t).camera.yaw_deg, at(path, t + 1200.0).camera.yaw_deg, 1e-3F);
    EXPECT_EQ(at(path, t).camera.fov_deg, 30.0F);
  }
  // The speed is the same on both sides of the seam, 120 degrees in 5 s and in 3 s: the camera turns on.
  const auto yaw = [&](double t) { return static_cast<double>(at(path, t).camera.yaw_deg); };
  const double speed_after = (yaw(2.02) - yaw(2.0)) / 0.02;
  const double speed_before = (yaw(14.0) + 360.0 - yaw(13.98)) / 0.02;
  EXPECT_NEAR(speed_before, speed_after, 0.5);
  EXPECT_GT(speed_after, 20.0);
  EXPECT_NEAR(yaw(0.5), yaw(12.5), 1e-3);  // before the first frame too
}

TEST(ScenePath, TheSunByDateAndPlace) {
  CameraPath path;
  path.place = {46.6, 8.0};
  path.frames = {frame(0.0), frame(10.0)};
  path.frames[0].julian_day = parse_time("2026-06-21T03:00:00Z", "test").value();
  path.frames[1].julian_day = parse_time("2026-06-21T11:00:00Z", "test").value();
  SceneParams base;
  base.sun.animate = true;
  for (const double t : {0.0, 5.0, 10.0}) {
    // The date is that of the keyframes at both ends of the interval and, by symmetry, halfway between them in its
    // middle.
    const double day =
        *path.frames[0].julian_day + t / 10.0 * (*path.frames[1].julian_day - *path.frames[0].julian_day);
    const SolarPosition sun = solar_position(path.place, day);
    EXPECT_NEAR(static_cast<double>(at(path, t, base).sun.elevation_deg), sun.elevation_deg, 1e-4);
    EXPECT_NEAR(static_cast<double>(at(path, t, base).sun.azimuth_deg), sun.azimuth_deg, 1e-3);
    EXPECT_EQ(at(path, t, base).sun.animate, false);
  }
}

TEST(ScenePath, TheMoonOfADatedPathFollowsTheDates) {
  CameraPath path;
  path.place = {46.6, 8.0};
  path.frames = {frame(0.0), frame(10.0)};
  path.frames[0].julian_day = parse_time("2026-06-21T03:00:00Z", "test").value();
  path.frames[1].julian_day = parse_time("2026-06-21T11:00:00Z", "test").value();
  SceneParams base;
  base.sun.time = "2026-01-01T00:00:00Z";
  base.sun.place = "46.6,8.0";
  base.moon.by_date = true;
  const SceneParams last = at(path, 10.0, base);
  SunParams sun = base.sun;
  sun.time = "2026-06-21T11:00:00Z";
  const MoonParams expected = placed_moon(base.moon, sun, {}).value();
  const Result<MoonParams> found = placed_moon(last.moon, last.sun, {});
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_NEAR(found.value().elevation_deg, expected.elevation_deg, 1e-3);
  EXPECT_NEAR(found.value().azimuth_deg, expected.azimuth_deg, 1e-3);
  EXPECT_NEAR(found.value().angular_radius_deg, expected.angular_radius_deg, 1e-5);
  EXPECT_GT(std::abs(at(path, 0.0, base).moon.azimuth_deg - last.moon.azimuth_deg), 10.0F);
  EXPECT_FALSE(CameraPath().moves_sun());
  EXPECT_TRUE(path.moves_sun());
}

}  // namespace
}  // namespace tyndall::scene
