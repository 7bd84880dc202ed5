// Refused settings are reverted, and only these.
#include <gtest/gtest.h>

#include "viewer/scenes/settings_compare.hpp"
#include "viewer/view_settings.hpp"

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

// Both sides of a comparison have the same date, which may place the moon.
TEST(ViewerSettings, BothSidesHaveTheSameMoonInTheSky) {
  ViewSettings settings;
  settings.left.scene.sun.time = "2026-06-21T22:00:00Z";
  settings.left.scene.sun.place = "46,7";
  settings.left.scene.moon.by_date = true;
  settings.right = settings.left;
  settings.right.scene.moon.visible = true;
  settings.left.scene.sun.time.clear();
  settings.left.scene.moon.by_date = false;
  settings.left.scene.moon.elevation_deg = 21.0F;
  settings.synchronise(true);
  EXPECT_FALSE(settings.right.scene.moon.by_date);
  EXPECT_EQ(settings.right.scene.moon.elevation_deg, 21.0F);
  EXPECT_TRUE(settings.right.scene.moon.visible) << "how the moon looks may differ";
}

}  // namespace
}  // namespace tyndall::viewer
