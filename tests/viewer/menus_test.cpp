// Menus and buttons used with the mouse, and the help at the first start.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "config/settings.hpp"
#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;

// Presets change only the parameters that they contain. VSync selects the present mode of the window.
TEST(Window, AppliesPresetsAndVsyncFromTheMenus) {
  NEEDS_A_DESK();
  Desk desk("menus");
  ASSERT_TRUE(desk.open(joined(kSmallTables, {"--size", "800x600", "--no-first-steps", "--set", "camera.fov_deg=33"})))
      << desk.errors();
  for (const char* preset : {"heavy_haze", "high_performance"}) {
    const std::size_t from = desk.lines();
    ASSERT_TRUE(desk.click("menu.Presets"));
    ASSERT_TRUE(desk.click(std::string("item.") + preset)) << preset;
    EXPECT_TRUE(desk.wait_for({"loaded ", std::string("presets/") + preset + ".toml"}, from)) << preset;
    EXPECT_TRUE(desk.wait_for({"frame left"}, from)) << preset;
    EXPECT_EQ(last_frame(desk).fov, 33.0) << "not of the preset";
  }
  const std::optional<std::string> first = desk.wait_for({" present_mode "});
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->ends_with(" fifo")) << *first;
  std::size_t from = desk.lines();
  ASSERT_TRUE(desk.click("button.vsync", 0.1));
  const std::optional<std::string> off = desk.wait_for({" present_mode "}, from, 20.0);
  ASSERT_TRUE(off);
  EXPECT_FALSE(off->ends_with(" fifo")) << *off;
  desk.picture("without_vsync");
  from = desk.lines();
  ASSERT_TRUE(desk.click("button.vsync", 0.1));
  EXPECT_TRUE(desk.wait_for({" present_mode fifo"}, from, 20.0));
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

// At the first start with a state folder, a window explains how to move, to turn the sun and to add haze. Once it has
// been closed, it does not appear again.
TEST(Window, ShowsTheFirstStepsOnce) {
  NEEDS_A_DESK();
  Desk desk("first_steps");
  const std::vector<std::string> arguments = joined(kSmallTables, {"--size", "640x480"});
  ASSERT_TRUE(desk.open(arguments)) << desk.errors();
  for (const char* line : {"Move", "Turn the sun", "More haze", "All keys"})
    EXPECT_TRUE(desk.wait_for_place(std::string("first_run.") + line)) << line;
  desk.picture("first");
  // The slider of the haze that it mentions is visible from the start.
  EXPECT_TRUE(desk.wait_for_place("atmosphere.aerosol_density"));
  ASSERT_TRUE(desk.click("first_run.close"));
  EXPECT_TRUE(desk.wait_for_place("first_run.close", false));
  EXPECT_EQ(desk.leave(), 0) << desk.errors();

  ASSERT_TRUE(desk.open(arguments)) << desk.errors();
  ASSERT_TRUE(desk.wait_for_place("menu.Help"));
  EXPECT_TRUE(desk.wait_for_place("first_run.close", false));
  // The menu opens the window again.
  ASSERT_TRUE(desk.click("menu.Help"));
  ASSERT_TRUE(desk.click("item.First steps"));
  EXPECT_TRUE(desk.wait_for_place("first_run.close"));
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

}  // namespace
}  // namespace tyndall
