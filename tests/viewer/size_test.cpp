// The window is resized, minimised, shown on the full screen, and at rest.
#include <gtest/gtest.h>

#include <string>

#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;

TEST(Window, IsResizedAndIdlesWhenNothingChanges) {
  NEEDS_A_DESK();
  Desk desk("resize");
  ASSERT_TRUE(desk.open(kSmall)) << desk.errors();
  for (int i = 0; i < 20; ++i) {
    const int width = 200 + 2 * ((i * 37) % 280);
    const int height = 150 + 2 * ((i * 53) % 180);
    const std::size_t from = desk.lines();
    desk.input("windowsize " + desk.window() + " " + std::to_string(width) + " " + std::to_string(height));
    ASSERT_TRUE(
        desk.wait_for({"frame left", " " + std::to_string(width / 2) + " " + std::to_string(height / 2) + " "}, from))
        << i;
  }
  desk.picture("resized");
  // Nothing is drawn while the window is unmapped. Afterwards drawing continues.
  desk.input("windowunmap --sync " + desk.window());
  desk.input("windowmap --sync " + desk.window());
  // At rest, after all pipelines have been created and the exposure has adapted, the loop stops.
  ASSERT_TRUE(desk.wait_for({"pipelines"}));
  ASSERT_TRUE(desk.wait_for({"resting"}));
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

// Nothing is drawn while the window is minimised. Minimising requires a window manager.
TEST(Window, IsMinimisedAndRestored) {
  NEEDS_A_DESK();
  Desk desk("minimised");
  if (!desk.manage()) GTEST_SKIP() << "openbox is not installed";
  ASSERT_TRUE(desk.open(kSmall)) << desk.errors();
  for (int i = 0; i < 3; ++i) {
    std::size_t from = desk.lines();
    desk.input("windowminimize " + desk.window());
    ASSERT_TRUE(desk.wait_for({"minimised"}, from));
    from = desk.lines();
    desk.input("windowactivate " + desk.window());
    ASSERT_TRUE(desk.wait_for({"restored"}, from));
    from = desk.lines();
    desk.input("key w");
    ASSERT_TRUE(desk.wait_for({"frame left"}, from)) << i;
  }
  // Switches between full screen and window under a window manager.
  std::size_t from = desk.lines();
  desk.input("key F11");
  ASSERT_TRUE(desk.wait_for({"shown", " in 800 600"}, from));
  desk.picture("full_screen");
  from = desk.lines();
  desk.input("key F11");
  ASSERT_TRUE(desk.wait_for({"shown", " in 480 270"}, from));
  desk.picture("back");
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

}  // namespace
}  // namespace tyndall
