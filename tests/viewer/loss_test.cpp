// Loss of the surface, of the device and of the display.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "config/scene_file.hpp"
#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;

TEST(Window, RecreatesALostSurfaceAndSavesTheStateOfALostDevice) {
  NEEDS_A_DESK();
  {
    Desk desk("lost_surface");
    std::vector<std::string> arguments = joined(kSmall, kSmallTables);
    arguments.insert(arguments.end(), {"--script", "lose-surface"});
    ASSERT_TRUE(desk.open(arguments)) << desk.errors();
    ASSERT_TRUE(desk.wait_for({"surface lost"}));
    const std::size_t from = desk.lines();
    desk.input("key w");
    EXPECT_TRUE(desk.wait_for({"frame left"}, from));
    EXPECT_EQ(desk.leave(), 0) << desk.errors();
  }
  Desk desk("lost_device");
  std::vector<std::string> arguments = joined(kSmall, kSmallTables);
  arguments.insert(arguments.end(), {"--script", "lose-device", "--set", "sun.azimuth_deg=123"});
  desk.open(arguments);
  EXPECT_EQ(desk.wait_for_end(240.0), 1);
  EXPECT_NE(desk.errors().find("tyndall: error: tyndall view: the Vulkan device was lost"), std::string::npos)
      << desk.errors();
  EXPECT_NE(desk.errors().find("state.toml"), std::string::npos);
  config::Settings state;
  ASSERT_TRUE(config::load(state, desk.folder() + "/state.toml").ok());
  EXPECT_EQ(state.scene.sun.azimuth_deg, 123.0F);
}

// The window is destroyed, the connection of the viewer is closed, or the X server ends.
TEST(Window, SavesTheStateWhenTheDisplayIsLost) {
  NEEDS_A_DESK();
  for (const char* what : {"destroyed", "killed", "server"}) {
    Desk desk(std::string("lost_display_") + what);
    ASSERT_TRUE(desk.open(joined(joined(kSmall, kSmallTables), {"--set", "sun.azimuth_deg=123"}))) << desk.errors();
    if (what == std::string("destroyed")) desk.input("windowclose " + desk.window());
    if (what == std::string("killed")) desk.input("windowkill " + desk.window());
    if (what == std::string("server")) desk.end_server();
    EXPECT_EQ(desk.wait_for_end(60.0), 1) << what;
    const std::string said = desk.errors();
    EXPECT_NE(said.find("tyndall: error: tyndall view: the window's surface was lost"), std::string::npos)
        << what << ": " << said;
    EXPECT_NE(said.find("the state is saved; 'tyndall view "), std::string::npos) << what << ": " << said;
    EXPECT_EQ(said.find("tyndall: error", 1), std::string::npos) << "said once: " << said;
    config::Settings state;
    ASSERT_TRUE(config::load(state, desk.folder() + "/state.toml").ok()) << what;
    EXPECT_EQ(state.scene.sun.azimuth_deg, 123.0F);
  }
}

}  // namespace
}  // namespace tyndall
