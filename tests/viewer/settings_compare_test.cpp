// What is refused goes back, and nothing else.
#include <gtest/gtest.h>

#include "viewer/scenes/settings_compare.hpp"

namespace tyndall::viewer {
namespace {

TEST(ViewerSettings, RefusedSettingsAreRevertedButLaterChangesStay) {
  config::Settings had, asked, now;
  asked.effect.tables.size = {4, 4, 4, 4096};
  asked.effect.atmosphere.mie_g = 0.5F;
  asked.scene.terrain.source = "nowhere.tif";
  now = asked;
  now.effect.atmosphere.mie_g = 0.6F;  // changed again
  now.effect.scattering.scale = 2.0F;  // changed since
  go_back(now, asked, had);
  config::Settings wanted = had;
  wanted.effect.atmosphere.mie_g = 0.6F;
  wanted.effect.scattering.scale = 2.0F;
  EXPECT_TRUE(same_settings(now, wanted));
}

}  // namespace
}  // namespace tyndall::viewer
