// Models in the viewer: selected from the menu, and two of them in a comparison.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;

// Selects the entry of the menu that begins with `name`.
bool choose(Desk& desk, const std::string& name) { return desk.click("menu.Model") && desk.click("item." + name); }

TEST(Window, ComparesTwoModels) {
  NEEDS_A_DESK();
  Desk desk("models");
  ASSERT_TRUE(desk.open(joined(kSmallTables, {"--size", "800x600", "--no-first-steps"}))) << desk.errors();
  std::size_t from = desk.lines();
  ASSERT_TRUE(choose(desk, "Homogeneous medium, light shafts (Yusov 2012)"));
  ASSERT_TRUE(desk.wait_for({"set scattering.medium=homogeneous"}, from));
  ASSERT_TRUE(desk.wait_for({"frame left"}, from));
  from = desk.lines();
  ASSERT_TRUE(choose(desk, "Atmosphere, all orders, light shafts (Yusov 2013)"));
  ASSERT_TRUE(desk.wait_for({"set scattering.medium=atmosphere"}, from));

  ASSERT_TRUE(compare_two(desk));
  ASSERT_TRUE(desk.click("side.right"));
  // A model is selected for the right side. The left side is unchanged.
  for (const auto& [name, value] : {std::pair{"Air and haze (Hoffman and Preetham 2002)", "homogeneous"},
                                    {"Scale function (O'Neil 2005)", "oneil"},
                                    {"Table (O'Neil 2004)", "oneil-table"}}) {
    from = desk.lines();
    ASSERT_TRUE(choose(desk, name));
    ASSERT_TRUE(desk.wait_for({std::string("set right scattering.model=") + value}, from)) << value;
    ASSERT_TRUE(desk.wait_for({"frame right"}, from)) << value;
    desk.picture(value);
  }
  EXPECT_EQ(log_text(desk).find("set scattering.model"), std::string::npos);
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

}  // namespace
}  // namespace tyndall
