// Parameters by name: the joint table, setting from text, exact round trips, messages.
#include "config/settings.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <set>

#include "config/scene_file.hpp"
#include "files/text.hpp"

namespace tyndall::config {
namespace {

std::string failure(std::string_view assignment) {
  Settings settings;
  const Result<void> result = set(settings, assignment);
  return result ? "(accepted)" : result.error().message;
}

TEST(ConfigSettings, QuotesInSceneFiles) {
  const auto refusal = [](std::string_view toml) {
    Settings settings;
    const Result<void> result = load_text(settings, toml, "s.toml");
    return result ? "(accepted)" : result.error().message;
  };
  EXPECT_EQ(
      refusal("\"sun.elevation_deg\" = 20\n"),
      "s.toml:1: the name 'sun.elevation_deg' is in quotes; expected it without quotes, because its dot separates "
      "table and parameter");
  EXPECT_EQ(refusal("sun.elevation_deg = 20\n"), "(accepted)");
  EXPECT_EQ(refusal("[sun]\ntime = 2026-06-21T06:00:00Z\n"),
            "s.toml:2: 'sun.time' is a date or time; expected text in UTF-8, in quotes");
}

TEST(ConfigSettings, KeysAreUniqueAndDefaultsAreAllowed) {
  std::set<std::string> seen;
  for (const Row& row : rows()) {
    EXPECT_TRUE(seen.insert(row.key()).second) << row.key();
    EXPECT_FALSE(row.info.doc.empty()) << row.key();
    EXPECT_EQ(row.info.name.back() == '_', false) << row.key();
    // The text of the default must be accepted: in range, a known choice, the right count.
    Settings settings;
    const Result<void> result = set(settings, row.key(), value_text(row, settings), "default");
    EXPECT_TRUE(result.ok()) << result.error().message;
  }
  EXPECT_NE(find_row("tonemap.operator"), nullptr);
  EXPECT_NE(find_row("camera.yaw_deg"), nullptr);
  EXPECT_EQ(find_row("tonemap.operator_"), nullptr);
}

TEST(ConfigSettings, SetReachesTheMembers) {
  Settings settings;
  ASSERT_TRUE(set(settings, "camera.yaw_deg=-12.5").ok());
  ASSERT_TRUE(set(settings, "atmosphere.rayleigh_scattering = 5.8e-6, 13.5e-6 ,33.1e-6").ok());
  ASSERT_TRUE(set(settings, "atmosphere.mie_phase=henyey-greenstein").ok());
  ASSERT_TRUE(set(settings, "tonemap.operator=exponential").ok());
  ASSERT_TRUE(set(settings, "shadows.cascades=8").ok());
  ASSERT_TRUE(set(settings, "scattering.light_shafts=off").ok());
  ASSERT_TRUE(set(settings, "sun.animate=1").ok());
  ASSERT_TRUE(set(settings, "terrain.source=/data/a=b, c.tif").ok());
  ASSERT_TRUE(set(settings, "terrain.seed=4294967295").ok());
  EXPECT_EQ(settings.scene.camera.yaw_deg, -12.5F);
  EXPECT_EQ(settings.effect.atmosphere.rayleigh_scattering, Vec3(5.8e-6F, 13.5e-6F, 33.1e-6F));
  EXPECT_EQ(settings.effect.atmosphere.mie_phase, MiePhase::henyey_greenstein);
  EXPECT_EQ(settings.scene.tonemap.operator_, scene::TonemapOperator::exponential);
  EXPECT_EQ(settings.scene.shadows.cascades, 8U);
  EXPECT_FALSE(settings.effect.scattering.light_shafts);
  EXPECT_TRUE(settings.scene.sun.animate);
  EXPECT_EQ(settings.scene.terrain.source, "/data/a=b, c.tif");
  EXPECT_EQ(settings.scene.terrain.seed, 4294967295U);
}

TEST(ConfigSettings, OneValueOfAColourMeansGrey) {
  Settings settings;
  ASSERT_TRUE(set(settings, "sun.irradiance=3.5").ok());
  EXPECT_EQ(settings.scene.sun.irradiance, Vec3(3.5F));
  EXPECT_EQ(value_text(*find_row("sun.irradiance"), settings), "3.5,3.5,3.5");
  ASSERT_TRUE(set(settings, "sun.irradiance=1, 2 ,4").ok());
  EXPECT_EQ(settings.scene.sun.irradiance, Vec3(1.0F, 2.0F, 4.0F));
  EXPECT_EQ(failure("sun.irradiance=1,2"), "--set: 'sun.irradiance' = '1,2' is not 1 or 3 numbers separated by commas; "
                                           "expected 1 or 3 numbers, each 0 to 1e+06 relative");
  EXPECT_EQ(failure("sun.irradiance=-1"),
            "--set: 'sun.irradiance' = '-1' is out of range; expected 1 or 3 numbers, each 0 to 1e+06 relative");
  EXPECT_FALSE(set(settings, "camera.position_m=1").ok());  // a single value is only accepted for colours
}

TEST(ConfigSettings, LimitsThemselvesAreAllowed) {
  Settings settings;
  EXPECT_TRUE(set(settings, "atmosphere.mie_g=0.99").ok());  // float(0.99) is above double 0.99
  EXPECT_EQ(failure("atmosphere.mie_g=0.9900001"),
            "--set: 'atmosphere.mie_g' = '0.9900001' is out of range; expected -0.99 to 0.99");
}

TEST(ConfigSettings, FloatsReadBackExactly) {
  const Row& row = *find_row("atmosphere.rayleigh_scattering");
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    Settings settings;
    Vec3& value = settings.effect.atmosphere.rayleigh_scattering;
    for (float* component : {&value.x, &value.y, &value.z}) {
      do {
        *component = std::bit_cast<float>(static_cast<std::uint32_t>(random()) & 0x7fffffffU);
      } while (!(*component <= static_cast<float>(row.info.max)));
    }
    Settings back;
    ASSERT_TRUE(set(back, row.key(), value_text(row, settings), "test").ok()) << value_text(row, settings);
    ASSERT_EQ(back.effect.atmosphere.rayleigh_scattering, value) << value_text(row, settings);
  }
}

TEST(ConfigSettings, PositionsReadBackInDoublePrecision) {
  std::mt19937_64 random(8);
  for (const char* key : {"camera.position_m", "meshes.position_m"}) {
    const Row& row = *find_row(key);
    const auto place = [&](Settings& of) -> DVec3& {
      return row.info.group == "camera" ? of.scene.camera.position_m : of.scene.meshes.position_m;
    };
    for (int i = 0; i < 5000; ++i) {
      Settings settings;
      std::uniform_real_distribution<double> any(row.info.min, row.info.max);
      place(settings) = {any(random), any(random), any(random)};
      Settings back;
      ASSERT_TRUE(set(back, row.key(), value_text(row, settings), "test").ok()) << value_text(row, settings);
      ASSERT_EQ(place(back), place(settings)) << value_text(row, settings);
      if (i % 20 != 0) continue;  // a scene file holds every parameter: it takes much longer
      Settings filed;
      ASSERT_TRUE(load_text(filed, to_toml(settings), "test").ok());
      ASSERT_EQ(place(filed), place(settings)) << value_text(row, settings);
    }
  }
  // Positions resolve a centimetre at a distance of 5000 km, where floats are half a metre apart.
  Settings far;
  ASSERT_TRUE(set(far, "camera.position_m=5000000.01,-2000000.02,0.5").ok());
  EXPECT_EQ(far.scene.camera.position_m, DVec3(5000000.01, -2000000.02, 0.5));
}

TEST(ConfigSettings, MessagesNameTheErrorItsSourceAndTheAllowedValues) {
  EXPECT_EQ(failure("atmosphere.mie_gg=0.5"),
            "--set: unknown parameter 'atmosphere.mie_gg'; did you mean 'atmosphere.mie_g'?");
  EXPECT_EQ(failure("atmopshere.mie_g=0.5"),
            "--set: unknown parameter 'atmopshere.mie_g'; did you mean 'atmosphere.mie_g'?");
  EXPECT_EQ(failure("mie_g=0.5"), "--set: unknown parameter 'mie_g'; did you mean 'atmosphere.mie_g'?");
  EXPECT_EQ(failure("sky.exposure=0.5"), "--set: unknown parameter 'sky.exposure'; did you mean 'tonemap.exposure'?");
  EXPECT_EQ(failure("planet.zzzzzzzzzzzz=1"),
            "--set: unknown parameter 'planet.zzzzzzzzzzzz'; 'planet' has radius_m, ground_albedo");
  EXPECT_EQ(failure("qqqqqqqqqqqqqqqqq=1"), "--set: unknown parameter 'qqqqqqqqqqqqqqqqq'; see 'tyndall params'");
  EXPECT_EQ(failure("camera.yaw_deg"), "--set: invalid assignment 'camera.yaw_deg'; expected KEY=VALUE");
  EXPECT_EQ(failure("=3"), "--set: invalid assignment '=3'; expected KEY=VALUE");
  EXPECT_EQ(failure("camera.fov_deg=wide"),
            "--set: 'camera.fov_deg' = 'wide' is not one number; expected 1 to 170 deg");
  EXPECT_EQ(failure("camera.fov_deg="), "--set: 'camera.fov_deg' = '' is not one number; expected 1 to 170 deg");
  EXPECT_EQ(failure("camera.fov_deg=nan"),
            "--set: 'camera.fov_deg' = 'nan' is not a finite number; expected 1 to 170 deg");
  EXPECT_EQ(failure("camera.fov_deg=-inf"),
            "--set: 'camera.fov_deg' = '-inf' is not a finite number; expected 1 to 170 deg");
  EXPECT_EQ(failure("camera.fov_deg=1e999"),
            "--set: 'camera.fov_deg' = '1e999' is out of range; expected 1 to 170 deg");
  EXPECT_EQ(failure("shadows.cascades=3.5"),
            "--set: 'shadows.cascades' = '3.5' is not one whole number; expected a whole number, 1 to 8 "
            "cascades");
  EXPECT_EQ(failure("shadows.cascades=99999999999999999999999"),
            "--set: 'shadows.cascades' = '99999999999999999999999' is out of range; expected a whole number, 1 "
            "to 8 cascades");
  EXPECT_EQ(failure("camera.position_m=1,2"),
            "--set: 'camera.position_m' = '1,2' is not 3 numbers separated by commas; expected 3 numbers, each "
            "-1e+09 to 1e+09 m");
  EXPECT_EQ(failure("camera.position_m=1,,2"),
            "--set: 'camera.position_m' = '' is not 3 numbers; expected 3 numbers, each -1e+09 to 1e+09 m");
  EXPECT_EQ(failure("scattering.enabled=yes"),
            "--set: 'scattering.enabled' = 'yes' is neither on nor off; expected true or false");
  EXPECT_EQ(failure("terrain.shading=shiny"),
            "--set: 'terrain.shading' = 'shiny' is not one of its values; expected materials, height, plain");
  EXPECT_EQ(failure("terrain.source=\xff\xfe"),
            "--set: 'terrain.source' = '?\?' is not valid UTF-8; expected text in UTF-8");
}

TEST(ConfigSettings, AFailedSetChangesNothing) {
  Settings settings;
  EXPECT_FALSE(set(settings, "camera.position_m=1,2,x").ok());
  EXPECT_EQ(settings.scene.camera.position_m, Settings().scene.camera.position_m);
}

TEST(ConfigSettings, ValuesTooSmallForAFloatAreZero) {
  Settings settings;
  ASSERT_TRUE(set(settings, "camera.yaw_deg=1e-60").ok());
  EXPECT_EQ(settings.scene.camera.yaw_deg, 0.0F);
  ASSERT_TRUE(set(settings, "camera.yaw_deg=-1e-400").ok());
  EXPECT_EQ(settings.scene.camera.yaw_deg, 0.0F);
}

TEST(ConfigText, NumbersBeyondTheRangeOfADouble) {
  double value = 1.0;
  for (const std::string& tiny : {std::string("1e-400"), std::string("-4.9e-330"), "0." + std::string(400, '0') + "1",
                                  "1" + std::string(400, '0') + "e-900"}) {
    value = 1.0;
    EXPECT_EQ(files::read_number(tiny, value), files::NumberError::none) << tiny;
    EXPECT_EQ(value, 0.0) << tiny;
  }
  EXPECT_EQ(files::read_number("3e-310", value), files::NumberError::none);  // subnormal
  EXPECT_NEAR(value / 3e-310, 1.0, 1e-12);
  for (const std::string& huge :
       {std::string("1e400"), "1" + std::string(400, '0'), "0." + std::string(400, '0') + "1e900"}) {
    EXPECT_EQ(files::read_number(huge, value), files::NumberError::too_large) << huge;
  }
}

TEST(ConfigSettings, CrossChecks) {
  Settings settings;
  EXPECT_TRUE(check(settings).ok());
  settings.scene.shadows.cascades = 2;
  settings.scene.shadows.first_marched = 2;
  ASSERT_FALSE(check(settings).ok());
  EXPECT_EQ(check(settings).error().message,
            "shadows.first_marched: 2 is not below shadows.cascades = 2; expected 0 to 1");
  settings = Settings();
  settings.effect.scattering.downscale = 3;
  ASSERT_FALSE(check(settings).ok());
  EXPECT_EQ(check(settings).error().message, "scattering.downscale is 3; expected 1, 2 or 4");
  settings = Settings();
  settings.effect.tables.size.y = 33;
  EXPECT_FALSE(check(settings).ok());
  settings = Settings();
  settings.scene.terrain.source.clear();
  EXPECT_FALSE(check(settings).ok());
  settings = Settings();
  settings.path.frames.resize(2);
  settings.path.frames[1].time_s = 1.0;
  for (scene::PathFrame& frame : settings.path.frames) frame.julian_day = 2460000.0;
  ASSERT_FALSE(check(settings).ok());
  EXPECT_EQ(check(settings).error().message, "[playback]: a path with dates has no place; expected place = "
                                             "\"LAT,LON\", or an elevation file with a coordinate "
                                             "system in terrain.source");
  settings.scene.terrain.source = "mine.tif";
  EXPECT_TRUE(check(settings).ok());
  // Angles of the sun say nothing about where the moon is.
  for (scene::PathFrame& frame : settings.path.frames) {
    frame.julian_day.reset();
    frame.sun_elevation_deg = 10.0F;
  }
  settings.scene.sun.time = "2026-06-21T06:00:00Z";
  EXPECT_TRUE(check(settings).ok());
  settings.scene.moon.by_date = true;
  ASSERT_FALSE(check(settings).ok());
  EXPECT_EQ(check(settings).error().message,
            "moon.by_date: the camera path moves the sun without dates; expected date in the frames of the path, or "
            "moon.by_date = false");
  settings = Settings();
  settings.scene.tables.cache.clear();
  EXPECT_FALSE(check(settings).ok());
  settings = Settings();
  settings.scene.homogeneous.haze_length_m = 9000.0F;
  ASSERT_FALSE(check(settings).ok());
  EXPECT_EQ(check(settings).error().message,
            "homogeneous.haze_length_m: 9000 exceeds homogeneous.air_length_m; expected 1 to 8400");
  settings = Settings();
  settings.scene.sun.time = "2026-06-21T06:00:00Z";
  ASSERT_FALSE(check(settings).ok());
  EXPECT_EQ(check(settings).error().message,
            "sun.time: the time of the sun has no place; expected sun.place = \"LAT,LON\", or an elevation file with a "
            "coordinate system");
  settings.scene.terrain.source = "mine.tif";
  EXPECT_TRUE(check(settings).ok());
  settings.scene.sun.place = "46.6";
  EXPECT_FALSE(check(settings).ok());
  settings.scene.sun.place = "46.6,8.0";
  settings.scene.sun.time.clear();
  EXPECT_TRUE(check(settings).ok());
  settings.scene.sun.place = "146.6,8.0";
  EXPECT_FALSE(check(settings).ok());
}

// The dates of a path place the moon, so that sun.time is not needed.
TEST(ConfigSettings, PathsWithDatesPlaceTheMoon) {
  Settings settings;
  settings.scene.moon.by_date = true;
  EXPECT_FALSE(check(settings).ok());
  settings.path.frames.resize(2);
  settings.path.frames[1].time_s = 1.0;
  for (scene::PathFrame& frame : settings.path.frames) frame.julian_day = 2460000.0;
  settings.path.place_text = "46.6,8.0";
  const Result<void> checked = check(settings);
  EXPECT_TRUE(checked.ok()) << checked.error().message;
}

// Names with a meaning of their own are not those of files that happen to lie beside a scene.
TEST(ConfigSettings, KeywordsAreNotFilesBesideAScene) {
  namespace fs = std::filesystem;
  std::string pattern = (fs::temp_directory_path() / "tyndall-scene-XXXXXX").string();
  const fs::path folder = ::mkdtemp(pattern.data());
  for (const char* name : {"hall", "none", "procedural"}) fs::create_directory(folder / name);
  std::ofstream(folder / "scene.toml") << "terrain.source = \"none\"\nmeshes.source = \"hall\"\n";
  Settings settings;
  ASSERT_TRUE(load(settings, (folder / "scene.toml").string()).ok());
  EXPECT_EQ(settings.scene.terrain.source, "none");
  EXPECT_EQ(settings.scene.meshes.source, "hall");
  // The default, against another value in an included file.
  std::ofstream(folder / "other.toml") << "include = \"scene.toml\"\nterrain.source = \"procedural\"\n";
  ASSERT_TRUE(load(settings, (folder / "other.toml").string()).ok());
  EXPECT_EQ(settings.scene.terrain.source, "procedural");
  fs::remove_all(folder);
}

TEST(ConfigSettings, MetadataHoldsEverything) {
  Settings settings;
  ASSERT_TRUE(set(settings, "camera.yaw_deg=17").ok());
  const std::vector<std::pair<std::string, std::string>> list = metadata(settings);
  EXPECT_EQ(list.size(), rows().size() + 1);
  EXPECT_EQ(list[0].first, "tyndall.version");
  EXPECT_NE(std::find(list.begin(), list.end(), std::pair<std::string, std::string>("tyndall.camera.yaw_deg", "17")),
            list.end());
}

TEST(ConfigText, EditDistance) {
  EXPECT_EQ(files::edit_distance("", "abc"), 3U);
  EXPECT_EQ(files::edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(files::edit_distance("ab", "ba"), 1U);
  EXPECT_EQ(files::edit_distance("same", "same"), 0U);
}

TEST(ConfigText, Utf8) {
  EXPECT_TRUE(files::is_utf8("gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\x8c\x84"));
  EXPECT_FALSE(files::is_utf8("\xc3"));              // cut off
  EXPECT_FALSE(files::is_utf8("\xc0\x80"));          // overlong
  EXPECT_FALSE(files::is_utf8("\xed\xa0\x80"));      // surrogate
  EXPECT_FALSE(files::is_utf8("\xf4\x90\x80\x80"));  // beyond U+10FFFF
  EXPECT_FALSE(files::is_utf8("\x80"));
  EXPECT_EQ(files::one_line("a\nb\xff\xc3\xbc"), "a?b?\xc3\xbc");
  EXPECT_EQ(files::one_line("abcdef", 3), "abc...");
  EXPECT_EQ(files::quoted_text("a\"b\\c\n"), "\"a\\\"b\\\\c\\u000a\"");
}

}  // namespace
}  // namespace tyndall::config
