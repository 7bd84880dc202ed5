// Flights in the viewer: along the path of a scene file, with the poses and pictures of `tyndall render`, and to space.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "config/scene_file.hpp"
#include "image/image.hpp"
#include "image/metrics.hpp"
#include "scene/description/camera_path.hpp"
#include "scene/elevation/elevation_source.hpp"
#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;

// P plays the flight of the scene file. Every frame has a pose of the path, in their order, until the user moves.
TEST(Window, PlaysTheFlightOfTheScene) {
  NEEDS_A_DESK();
  Desk desk("flight");
  const std::string scene = std::string(TYNDALL_SOURCE_DIR) + "/scenes/flythrough.toml";
  std::vector<std::string> arguments = kSmall;
  arguments.insert(arguments.end(), {scene, "--set", "tables.size=8,16,16,4", "--set", "tables.orders=2"});
  ASSERT_TRUE(desk.open(arguments)) << desk.errors();
  config::Settings settings;
  ASSERT_TRUE(config::load(settings, scene).ok());
  std::size_t from = desk.lines();
  desk.input("key p");
  ASSERT_TRUE(desk.wait_for({"path begins"}, from));
  double last_s = -1.0;
  for (int i = 0; i < 5; ++i) {
    from = desk.lines();
    const std::optional<std::string> line = desk.wait_for({"frame left"}, from);
    ASSERT_TRUE(line);
    const Frame f = frame_of(*line);
    // Find the time of the path with the nearest pose.
    double nearest_m = 1.0e9;
    double at_s = 0.0;
    scene::SceneParams pose;
    for (double t = 0.0; t < 40.0; t += 0.002) {
      const scene::SceneParams p = scene::pose_at(settings.path, t, settings.scene, settings.effect.planet.radius_m);
      const double away_m = std::hypot(p.camera.position_m.x - f.x, p.camera.position_m.z - f.z);
      if (away_m >= nearest_m) continue;
      nearest_m = away_m;
      at_s = t;
      pose = p;
    }
    EXPECT_LT(nearest_m, 5.0) << *line;
    EXPECT_NEAR(f.yaw, pose.camera.yaw_deg, 0.05);
    EXPECT_NEAR(f.pitch, pose.camera.pitch_deg, 0.05);
    EXPECT_NEAR(f.elevation, pose.sun.elevation_deg, 0.01);
    EXPECT_GE(at_s, last_s);
    last_s = at_s;
  }
  EXPECT_GT(last_s, 0.0);
  desk.picture("flying");
  from = desk.lines();
  desk.input("key w");
  ASSERT_TRUE(desk.wait_for({"path stops"}, from));
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

// A screenshot during the flight equals the picture of `tyndall render` for the same time.
TEST(Window, FliesThroughThePicturesOfRender) {
  NEEDS_A_DESK();
  Desk desk("flight_picture");
  const std::string scene = std::string(TYNDALL_SOURCE_DIR) + "/scenes/flythrough.toml";
  ASSERT_TRUE(desk.open(joined(joined({"--size", "640x360", "--no-first-steps"}, kSmallTables), {scene})))
      << desk.errors();
  // The terrain has the same level of detail as in `render`.
  ASSERT_TRUE(desk.click("menu.Windows"));
  ASSERT_TRUE(desk.click("item.Performance"));
  ASSERT_TRUE(desk.click("coarseness", 0.2));
  ASSERT_TRUE(desk.click("coarseness.0", 0.2));
  std::size_t from = desk.lines();
  desk.input("key p");
  ASSERT_TRUE(desk.wait_for({"path begins"}, from));
  from = desk.lines();
  ASSERT_TRUE(desk.wait_for({"frame left"}, from));
  desk.input("key F12");
  const std::optional<std::string> shot = desk.wait_for({" screenshot "}, from);
  ASSERT_TRUE(shot);
  EXPECT_EQ(desk.leave(), 0) << desk.errors();

  const Result<image::File> seen = image::read(shot->substr(shot->find(" screenshot ") + 12) + ".exr");
  ASSERT_TRUE(seen.ok());
  // Find the time of the flight from the position. At this speed, a millimetre is a few microseconds.
  config::Settings flight, moment;
  ASSERT_TRUE(config::load(flight, scene).ok());
  for (const auto& [key, value] : seen.value().metadata) {
    if (key != "tyndall.camera.position_m") continue;
    ASSERT_TRUE(config::set(moment, "camera.position_m", value, "metadata").ok());
  }
  const auto away_m = [&](double t) {
    const scene::SceneParams pose = scene::pose_at(flight.path, t, flight.scene, flight.effect.planet.radius_m);
    const DVec3& a = pose.camera.position_m;
    const DVec3& b = moment.scene.camera.position_m;
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
  };
  double at_s = 0.0;
  for (double step_s = 0.01, first_s = 0.0, last_s = flight.path.duration_s(); step_s > 1.0e-7; step_s *= 0.1) {
    for (double t = first_s; t <= last_s; t += step_s) at_s = away_m(t) < away_m(at_s) ? t : at_s;
    first_s = std::max(at_s - step_s, 0.0);
    last_s = at_s + step_s;
  }
  EXPECT_LT(away_m(at_s), 0.1);
  EXPECT_LT(at_s, flight.path.duration_s() - 1.0) << "still in flight";
  const std::string size = std::to_string(seen.value().image.width) + "x" + std::to_string(seen.value().image.height);
  std::string command = std::string("'") + TYNDALL_EXECUTABLE + "' render '" + scene + "' --size " + size;
  for (const std::string& word : kSmallTables) command += " " + word;
  char step[32];
  std::snprintf(step, sizeof step, "%.7f", at_s);
  const std::string rendered = desk.folder() + "/rendered.1.exr";
  command += std::string(" --set tables.cache=" TYNDALL_TEST_CACHE " --set camera.samples=1 --frames 2 --time-step ") +
             step + " -o '" + desk.folder() + "/rendered.%d.exr' 2> '" + desk.folder() + "/render.txt'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  const Result<image::File> wanted = image::read(rendered);
  ASSERT_TRUE(wanted.ok());
  const image::Metrics difference = image::compare(seen.value().image, wanted.value().image);
  EXPECT_LT(difference.mean_relative_error, 1.0e-3);
  EXPECT_EQ(difference.non_finite_a, 0U);
  RecordProperty("mean_relative_error", std::to_string(difference.mean_relative_error));
}

// With the keys, the camera flies from the ground to space and back, without turning, without moving backwards, and not
// through the ground.
TEST(Window, FliesToOrbitAndBackToTheGround) {
  NEEDS_A_DESK();
  Desk desk("orbit");
  ASSERT_TRUE(desk.open(joined(kSmall, kSmallTables))) << desk.errors();
  const auto altitude_of = [](const Frame& f) {
    return std::sqrt(f.x * f.x + f.z * f.z + (f.y + 6.36e6) * (f.y + 6.36e6)) - 6.36e6;
  };
  const std::size_t first = frames(desk).size();
  std::size_t from = desk.lines();
  desk.input("keydown shift keydown e");
  while (altitude_of(last_frame(desk)) < 4.0e5) {
    ASSERT_TRUE(desk.wait_for({"frame left"}, from));
    from = desk.lines();
  }
  desk.input("keyup e keyup shift");
  ASSERT_TRUE(desk.wait_for({"settled"}, from));
  desk.picture("orbit");
  std::vector<Frame> way = frames(desk);
  for (std::size_t i = first; i < way.size(); ++i) {
    EXPECT_GT(altitude_of(way[i]), altitude_of(way[i - 1]) - 1.0);
    EXPECT_NEAR(way[i].yaw, way[first - 1].yaw, 0.1);
    EXPECT_NEAR(way[i].pitch, way[first - 1].pitch, 0.1);
  }
  const Result<scene::ElevationSource> ground = scene::ElevationSource::create({});
  ASSERT_TRUE(ground.ok());
  from = desk.lines();
  desk.input("keydown q");
  // Fly down until the ground stops the camera.
  ASSERT_TRUE(desk.settles_after({"frame left"}, from));
  desk.input("keyup q");
  way = frames(desk);
  for (const Frame& f : way) {
    // Near the origin, map and world coordinates differ only by the curvature of the planet.
    const double ground_m = ground.value().height_m(f.x, f.z, 4.0);
    EXPECT_GT(altitude_of(f), ground_m + 2.0) << f.x << " " << f.z;
  }
  EXPECT_LT(altitude_of(way.back()), 5000.0);
  desk.picture("ground");
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

}  // namespace
}  // namespace tyndall
