// No iteration of the GUI's loop takes long, whatever the scene thread does.
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "../sanitizers.hpp"
#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;

// The loop of the GUI runs while the scene works: no input waits for a frame of the scene, for tables, pipelines or
// another scene. The viewer itself measures the iterations.
void works_without_a_freeze(Desk& desk) {
  std::size_t from = desk.lines();
  desk.input("keydown w");
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(desk.wait_for({"frame left"}, from));
    from = desk.lines();
  }
  desk.input("keyup w");
  // Parameters of the atmosphere need other tables.
  ASSERT_TRUE(pull(desk, "atmosphere.aerosol_density", {0.3, 0.35, 0.4, 0.45, 0.5}));
  ASSERT_TRUE(desk.wait_for({"set atmosphere.aerosol_density"}, from));
  from = desk.lines();
  ASSERT_TRUE(desk.wait_for({"tables"}, from));
  ASSERT_TRUE(desk.click("tab.Additional"));
  from = desk.lines();
  ASSERT_TRUE(pull(desk, "shadows.cascades", {0.1, 0.6}));
  ASSERT_TRUE(desk.wait_for({"set shadows.cascades"}, from));
  ASSERT_TRUE(desk.wait_for({"frame left"}, from));
  // The comparison shows another technique, whose pipelines have not been created yet.
  from = desk.lines();
  ASSERT_TRUE(compare_two(desk));
  ASSERT_TRUE(desk.wait_for({"frame right"}, from));
  desk.picture("worked");
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
  const std::optional<std::string> line = desk.wait_for({" steps "});
  ASSERT_TRUE(line);
  std::istringstream text(*line);
  std::string word;
  double count = 0.0, longest_ms = 0.0;
  text >> word >> word >> count >> word >> longest_ms;
  EXPECT_GT(count, 100.0);
  EXPECT_LE(longest_ms, kSanitizers ? 2000.0 : 200.0) << *line;
  testing::Test::RecordProperty("longest_step_ms", static_cast<int>(longest_ms));
}

TEST(Window, NeverFreezes) {
  NEEDS_A_DESK();
  Desk desk("freeze");
  ASSERT_TRUE(desk.open({"--size", "640x360", "--no-first-steps"})) << desk.errors();
  works_without_a_freeze(desk);
}

// The window and the scenes share one device from two threads, as they do on a GPU.
TEST(Window, SharesOneDeviceWithTheScenes) {
  NEEDS_A_DESK();
  Desk desk("one_device");
  std::vector<std::string> arguments = kSmall;
  arguments.insert(arguments.end(), {"--script", "one-device"});
  ASSERT_TRUE(desk.open(arguments)) << desk.errors();
  std::size_t from = desk.lines();
  desk.input("keydown w");
  ASSERT_TRUE(desk.wait_for({"frame left"}, from));
  desk.input("keyup w");
  from = desk.lines();
  desk.input("windowsize " + desk.window() + " 400 300");
  ASSERT_TRUE(desk.wait_for({"frame left", " 200 150 "}, from));
  ASSERT_TRUE(desk.click("menu.Windows"));
  ASSERT_TRUE(desk.click("item.Views and comparison"));
  from = desk.lines();
  ASSERT_TRUE(desk.click("compare", 0.1));
  ASSERT_TRUE(desk.wait_for({"shown two"}, from));
  desk.picture("two");
  from = desk.lines();
  desk.input("key F11");
  ASSERT_TRUE(desk.wait_for({"frame right", " 400 300 "}, from));
  desk.picture("full_screen");
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

}  // namespace
}  // namespace tyndall
