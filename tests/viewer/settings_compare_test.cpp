// Refused settings are reverted, and only these.
#include <gtest/gtest.h>

#include "viewer/scenes/settings_compare.hpp"

namespace tyndall::viewer {
namespace {

TEST(ViewerSettings, RefusedSettingsAreRevertedButLaterChangesStay) {
  config::Settings had, requested, now;
  requested.effect.tables.size = {4, 4, 4, 4096};
  requested.effect.atmosphere.mie_g = 0.5F;
  requested.scene.terrain.source = "nowhere.tif";
  now = requested;
  now.effect.atmosphere.mie_g = 0.6F;  // changed a second time
  now.effect.scattering.scale = 2.0F;  // changed after the request
  go_back(now, requested, had);
  config::Settings wanted = had;
  wanted.effect.atmosphere.mie_g = 0.6F;
  wanted.effect.scattering.scale = 2.0F;
  EXPECT_TRUE(same_settings(now, wanted));
}

}  // namespace
}  // namespace tyndall::viewer
