// Keys and pointer: flight, sun, field of view, and F1 to F12.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "config/scene_file.hpp"
#include "image/image.hpp"
#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;

void expect_keys_to_fly(Desk& desk) {
  const Frame start = last_frame(desk);
  // W flies forward: north-west and down from the default camera.
  std::size_t from = desk.lines();
  desk.input("keydown w");
  ASSERT_TRUE(desk.wait_for({"frame left"}, from));
  desk.input("keyup w");
  ASSERT_TRUE(desk.wait_for({"settled"}, desk.lines()));
  const Frame f = last_frame(desk);
  EXPECT_LT(f.x, start.x - 1.0);
  EXPECT_LT(f.z, start.z - 1.0);
  EXPECT_LT(f.y, start.y);
  EXPECT_NEAR(f.pitch, start.pitch, 1.0e-6);
  // Each of the other keys moves the camera, faster with Shift.
  for (const char* key : {"s", "a", "d", "q", "e"}) {
    from = desk.lines();
    desk.input(std::string("key ") + key);
    EXPECT_TRUE(desk.settles_after({"frame left"}, from)) << key;
  }
}

void drag(Desk& desk, int button, int x0, int y0, int x1, int y1) {
  std::size_t at = desk.lines();
  desk.input("mousemove " + std::to_string(x0) + " " + std::to_string(y0));
  ASSERT_TRUE(desk.wait_for({"pointer " + std::to_string(x0) + " " + std::to_string(y0)}, at));
  at = desk.lines();
  desk.input("mousedown " + std::to_string(button));
  ASSERT_TRUE(desk.wait_for({"press"}, at));
  at = desk.lines();
  desk.input("mousemove " + std::to_string(x1) + " " + std::to_string(y1));
  ASSERT_TRUE(desk.wait_for({"frame left"}, at));
  at = desk.lines();
  desk.input("mouseup " + std::to_string(button));
  ASSERT_TRUE(desk.settles_after({"release"}, at));
}

// On the picture, dragging with the left button turns the view, and with the right button the sun.
void expect_drags_to_turn(Desk& desk) {
  Frame before = last_frame(desk);
  ASSERT_NO_FATAL_FAILURE(drag(desk, 1, 300, 100, 340, 120));
  Frame f = last_frame(desk);
  EXPECT_LT(f.yaw, before.yaw - 1.0);
  EXPECT_GT(f.pitch, before.pitch + 1.0);
  EXPECT_EQ(f.azimuth, before.azimuth);
  before = f;
  ASSERT_NO_FATAL_FAILURE(drag(desk, 3, 300, 120, 345, 90));
  f = last_frame(desk);
  EXPECT_GT(f.azimuth, before.azimuth + 10.0);
  EXPECT_GT(f.elevation, before.elevation + 10.0);
  EXPECT_EQ(f.yaw, before.yaw);
  const std::size_t from = desk.lines();
  desk.input("click 4");
  ASSERT_TRUE(desk.settles_after({"frame left"}, from));
  EXPECT_LT(last_frame(desk).fov, f.fov);
  desk.picture("2_flown");
}

// F5 saves the state, and F9 restores it.
void expect_settings_to_be_saved_and_loaded(Desk& desk) {
  std::size_t from = desk.lines();
  desk.input("key F5");
  ASSERT_TRUE(desk.wait_for({"saved"}, from));
  const Frame saved = last_frame(desk);
  config::Settings state;
  ASSERT_TRUE(config::load(state, desk.folder() + "/state.toml").ok());
  EXPECT_NEAR(state.scene.sun.azimuth_deg, saved.azimuth, 1.0e-3);
  EXPECT_NEAR(state.scene.camera.yaw_deg, saved.yaw, 1.0e-3);
  from = desk.lines();
  desk.input("key w");
  ASSERT_TRUE(desk.settles_after({"frame left"}, from));
  EXPECT_NE(last_frame(desk).x, saved.x);
  from = desk.lines();
  desk.input("key F9");
  ASSERT_TRUE(desk.settles_after({"loaded"}, from));
  EXPECT_NEAR(last_frame(desk).x, saved.x, 0.01);
  EXPECT_NEAR(last_frame(desk).yaw, saved.yaw, 1.0e-3);
}

// F12 saves both pictures with the right size and with the parameters as metadata.
void expect_screenshots(Desk& desk) {
  const std::size_t from = desk.lines();
  desk.input("key F12");
  const std::optional<std::string> shot = desk.wait_for({" screenshot "}, from);
  ASSERT_TRUE(shot);
  const std::string stem = shot->substr(shot->find(" screenshot ") + 12);
  for (const char* ending : {".png", ".exr"}) {
    const Result<image::File> file = image::read(stem + ending);
    ASSERT_TRUE(file.ok()) << stem + ending;
    EXPECT_EQ(file.value().image.width, 240U);  // half of the window on a device without a GPU
    EXPECT_EQ(file.value().image.height, 135U);
    const auto& rows = file.value().metadata;
    EXPECT_TRUE(
        std::any_of(rows.begin(), rows.end(), [](const auto& row) { return row.first == "tyndall.sun.azimuth_deg"; }));
  }
}

// F1 and F2 show and hide windows. F11 switches to full screen and back.
void expect_function_keys_to_change_the_window(Desk& desk) {
  std::size_t from = desk.lines();
  desk.input("key F1");
  ASSERT_TRUE(desk.wait_for({"key 290"}, from));
  desk.picture("3_help");
  desk.input("key F1");
  desk.input("key F2");
  ASSERT_TRUE(desk.wait_for({"key 291"}, from));
  desk.picture("4_without_gui");
  desk.input("key F2");
  from = desk.lines();
  desk.input("key F11");
  ASSERT_TRUE(desk.wait_for({"frame left", " 400 300 "}, from));
  ASSERT_TRUE(desk.wait_for({"shown", " in 800 600"}, from));
  desk.picture("5_full_screen");
  from = desk.lines();
  desk.input("key F11");
  ASSERT_TRUE(desk.wait_for({"frame left", " 240 135 "}, from));
}

TEST(Window, FollowsMouseAndKeys) {
  NEEDS_A_DESK();
  Desk desk("mouse_and_keys");
  ASSERT_TRUE(desk.open(kSmall)) << desk.errors();
  desk.picture("1_open");
  for (const auto step : {expect_keys_to_fly, expect_drags_to_turn, expect_settings_to_be_saved_and_loaded,
                          expect_screenshots, expect_function_keys_to_change_the_window}) {
    ASSERT_NO_FATAL_FAILURE(step(desk));
  }
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

}  // namespace
}  // namespace tyndall
