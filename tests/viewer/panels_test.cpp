// Panels, menus, views and the comparison, used with the mouse.
#include <gtest/gtest.h>

#include <string>

#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;

TEST(Window, OpensEveryPanelAndComparesByTheMouse) {
  NEEDS_A_DESK();
  Desk desk("panels");
  ASSERT_TRUE(desk.open({"--size", "800x600", "--no-first-steps"})) << desk.errors();
  for (const char* tab : {"Additional", "Tone mapping", "Atmosphere", "All", "Basic"}) {
    ASSERT_TRUE(desk.click(std::string("tab.") + tab)) << tab;
    EXPECT_TRUE(desk.wait_for_place(key_of(tab))) << tab;
    desk.picture(std::string("tab_") + tab);
  }
  // The mouse moves a slider to both of its ends.
  std::size_t from = desk.lines();
  ASSERT_TRUE(pull(desk, "scattering.scale", {-0.02}));
  ASSERT_TRUE(desk.wait_for({"set scattering.scale=0.01"}, from));
  from = desk.lines();
  ASSERT_TRUE(pull(desk, "scattering.scale", {0.9}));
  ASSERT_TRUE(desk.wait_for({"set scattering.scale=10"}, from));
  from = desk.lines();
  ASSERT_TRUE(desk.click("epipolar.show_sampling", 0.05));
  ASSERT_TRUE(desk.wait_for({"set epipolar.show_sampling=true"}, from));
  ASSERT_TRUE(desk.wait_for({"frame left"}, from));
  desk.picture("sampling");

  // The menu opens windows, and a comparison in which the other side is also drawn.
  for (const char* item : {"item.Performance", "item.Views and comparison"}) {
    ASSERT_TRUE(desk.click("menu.Windows"));
    ASSERT_TRUE(desk.click(item)) << item;
  }
  ASSERT_TRUE(desk.wait_for_place("compare"));
  from = desk.lines();
  ASSERT_TRUE(desk.click("compare", 0.1));
  ASSERT_TRUE(desk.wait_for({"shown two"}, from));
  desk.picture("comparison");
  // Show every view of intermediate results.
  for (int i = 1; i < 10; ++i) {
    ASSERT_TRUE(desk.click("shown", 0.3));
    ASSERT_TRUE(desk.click("shown." + std::to_string(i), 0.3)) << i;
    desk.picture("view_" + std::to_string(i));
  }
  // The menu opens a scene.
  from = desk.lines();
  ASSERT_TRUE(desk.click("menu.Scenes"));
  ASSERT_TRUE(desk.click("item.noon"));
  ASSERT_TRUE(desk.wait_for({"loaded"}, from));
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

}  // namespace
}  // namespace tyndall
