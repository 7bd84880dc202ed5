// Scene files: round trips, partial files, and a clear message for every error.
#include "config/scene_file.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "config/describe.hpp"
#include "files/access.hpp"
#include "files/files.hpp"

namespace tyndall::config {
namespace {

std::string failure(std::string_view toml) {
  Settings settings;
  const Result<void> result = load_text(settings, toml, "s.toml");
  return result ? "(accepted)" : result.error().message;
}

std::string all_text(const Settings& settings) {
  std::string text;
  for (const auto& [name, value] : metadata(settings)) text += name + "=" + value + "\n";
  return text;
}

// Returns a valid value for the row that differs from the default.
std::string other_value(const Row& row, const Settings& defaults) {
  const std::string now = value_text(row, defaults);
  const auto number = [&](double fraction) {
    return std::to_string(static_cast<std::int64_t>(row.info.min + fraction * (row.info.max - row.info.min)));
  };
  switch (row.info.type) {
    case ParamType::float32: return now == "0.1" || row.info.min >= 0.1 || row.info.max <= 0.1 ? number(0.7) : "0.1";
    case ParamType::uint32: return number(0.6);
    case ParamType::vec3:
    case ParamType::dvec3:
      return row.info.max <= 1.0 ? "0.1,1.5e-07,0.3" : number(0.3) + "," + number(0.7) + "," + number(0.5);
    case ParamType::uvec4: return number(1.0) + "," + number(0.5) + "," + number(0.25) + "," + number(0.0);
    case ParamType::flag: return now == "true" ? "false" : "true";
    case ParamType::enumeration: return std::string(row.info.choices.substr(row.info.choices.rfind('|') + 1));
    case ParamType::string: return "a \"quoted\" \\ n\xc3\xa4me.tif";
  }
  return "";
}

class SceneFile : public testing::Test {
 protected:
  SceneFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "tyndall-test-XXXXXX").string();
    directory_ = ::mkdtemp(pattern.data());
  }
  ~SceneFile() override { std::filesystem::remove_all(directory_); }

  std::string write(const std::string& name, std::string_view contents) {
    std::string path = (directory_ / name).string();
    std::ofstream(path, std::ios::binary) << contents;
    return path;
  }
  std::size_t entries() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(directory_)) ++count;
    return count;
  }

  std::filesystem::path directory_;
};

TEST_F(SceneFile, EveryParameterSurvivesARoundTrip) {
  Settings settings;
  for (const Row& row : rows()) {
    const Result<void> result = set(settings, row.key(), other_value(row, Settings()), "test");
    ASSERT_TRUE(result.ok()) << result.error().message;
  }
  Settings back;
  const Result<void> loaded = load_text(back, to_toml(settings), "round trip");
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  EXPECT_EQ(all_text(back), all_text(settings));
  EXPECT_NE(all_text(back), all_text(Settings()));

  const std::string path = (directory_ / "saved.toml").string();
  ASSERT_TRUE(save(settings, path).ok());
  Settings from_file;
  ASSERT_TRUE(load(from_file, path).ok());
  EXPECT_EQ(all_text(from_file), all_text(settings));
  EXPECT_EQ(entries(), 1U);
}

constexpr std::string_view kPath = R"(
[playback]
loop = false
place = "46.6,8.0"
[[path]]
time_s = 0
position_m = [-15000.0, 1500.5, -15000]
yaw_deg = 350.1
date = 2026-06-21T03:00:00Z
[[path]]
time_s = 12.5
altitude_m = 400000
pitch_deg = -10
fov_deg = 60
date = "2026-06-21T07:30:00+02:00"
)";

TEST_F(SceneFile, APathSurvivesARoundTrip) {
  Settings settings;
  const Result<void> loaded = load_text(settings, kPath, "p.toml");
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  ASSERT_EQ(settings.path.frames.size(), 2U);
  EXPECT_EQ(settings.path.frames[0].position_m->y, 1500.5);
  EXPECT_EQ(settings.path.frames[0].yaw_deg, 350.1F);
  EXPECT_FALSE(settings.path.frames[0].altitude_m.has_value());
  EXPECT_EQ(settings.path.frames[1].time_s, 12.5);
  EXPECT_EQ(settings.path.frames[1].fov_deg, 60.0F);
  EXPECT_NEAR(*settings.path.frames[1].julian_day - *settings.path.frames[0].julian_day, 2.5 / 24.0, 1e-8);
  EXPECT_EQ(settings.path.place.longitude_deg, 8.0);
  Settings back;
  const Result<void> again = load_text(back, to_toml(settings), "round trip");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(to_toml(back), to_toml(settings));
  EXPECT_EQ(back.path.frames[0].julian_day, settings.path.frames[0].julian_day);
  // Without frames nothing is written. Another path replaces the whole path.
  EXPECT_EQ(to_toml(Settings()).find("path"), std::string::npos);
  ASSERT_TRUE(load_text(back, "[[path]]\ntime_s = 0\n[[path]]\ntime_s = 1\nyaw_deg = 3\n", "q.toml").ok());
  EXPECT_EQ(back.path.frames.size(), 2U);
  EXPECT_EQ(back.path.place_text, "");
  // The last frame of a loop only has a time.
  ASSERT_TRUE(
      load_text(back, "playback.loop = true\n[[path]]\ntime_s = 0\nyaw_deg = 3\n[[path]]\ntime_s = 1\n", "l.toml")
          .ok());
  EXPECT_TRUE(back.path.loop);
}

TEST_F(SceneFile, ErrorsInPathsAreReportedWithTheirLine) {
  const std::string two = "[[path]]\ntime_s = 0\n[[path]]\ntime_s = 5\n";
  const std::pair<std::string, std::string> wrong[] = {
      {"path = 3", "s.toml:1: 'path' is not a list of frames; expected one table [[path]] for each frame"},
      {"[[path]]\ntime_s = 0\n", "s.toml:1: the path has only one frame; expected two or more [[path]]"},
      {"[[path]]\nyaw_deg = 0\n", "s.toml:1: a frame of the path has no time; expected time_s = SECONDS"},
      {two + "[[path]]\ntime_s = 5\n",
       "s.toml:5: the time of the path goes from 5 s to 5 s; expected a greater time_s in each frame"},
      {two + "yaw_dge = 3\n", "s.toml:5: unknown key 'yaw_dge' in [[path]]; did you mean 'yaw_deg'?"},
      {two + "xyz = 3\n",
       "s.toml:5: unknown key 'xyz' in [[path]]; expected one of time_s, position_m, date, altitude_m, yaw_deg, "
       "pitch_deg, fov_deg, sun_elevation_deg, sun_azimuth_deg"},
      {"[[path]]\ntime_s = -1\n", "s.toml:2: 'time_s' is not a time; expected a number, 0 to 1e+06 s"},
      {"[[path]]\ntime_s = nan\n", "s.toml:2: 'time_s' is not a time; expected a number, 0 to 1e+06 s"},
      {"[[path]]\ntime_s = \"0\"\n", "s.toml:2: 'time_s' is not a time; expected a number, 0 to 1e+06 s"},
      {two + "altitude_m = -1\n",
       "s.toml:5: 'altitude_m' is below sea level; expected 0 to 1e+09 m, or a lower altitude in position_m"},
      {two + "position_m = [1, 2]\n",
       "s.toml:5: 'camera.position_m' = '2 values' is not 3 numbers; expected 3 numbers, each -1e+09 to 1e+09 m"},
      {two + "fov_deg = 200\n", "s.toml:5: 'camera.fov_deg' = '200' is out of range; expected 1 to 170 deg"},
      {two + "date = \"yesterday\"\n", "yesterday"},
      {two + "date = \"2026-06-21T03:00:00Z\"\nsun_elevation_deg = 3\n",
       "s.toml:3: the path gives the sun both by date and by angles; expected only one of them"},
      {two + "[playback]\nloops = true\n", "s.toml:6: unknown key 'loops' in [playback]; did you mean 'loop'?"},
      {two + "[playback]\nloop = 1\n", "s.toml:6: 'loop' is a whole number; expected true or false"},
      {two + "[playback]\nplace = \"north\"\n", "s.toml:6"},
      {"[playback]\nloop = true\n", "s.toml:1: there is no path to loop; expected two or more [[path]]"},
      {"playback = 3", "s.toml:1: 'playback' is a whole number; expected a table"},
      {two + "yaw_deg = 3\n[playback]\nloop = true\n", "s.toml:6: the last frame of a loop has more than a time; "
                                                       "expected only time_s, because the frame repeats the first one"},
  };
  for (const auto& [toml, message] : wrong)
    EXPECT_NE(failure(toml).find(message), std::string::npos) << toml << failure(toml);
}

TEST_F(SceneFile, PartialFilesPreserveTheRestAndTheLastWins) {
  Settings settings;
  settings.scene.sun.azimuth_deg = 99.0F;
  ASSERT_TRUE(load_text(settings, "[sun]\nelevation_deg = 3\n", "a.toml").ok());
  ASSERT_TRUE(load_text(settings, "sun.elevation_deg = 4.5\r\ncamera = { yaw_deg = 1 }\r\n", "b.toml").ok());
  EXPECT_EQ(settings.scene.sun.elevation_deg, 4.5F);
  EXPECT_EQ(settings.scene.sun.azimuth_deg, 99.0F);
  EXPECT_EQ(settings.scene.camera.yaw_deg, 1.0F);
  for (const std::string_view empty : {"", "\n\n", "# only a comment", "[camera]\n", "\xEF\xBB\xBF"}) {
    Settings untouched;
    EXPECT_TRUE(load_text(untouched, empty, "empty").ok()) << empty;
    EXPECT_EQ(all_text(untouched), all_text(Settings()));
  }
}

TEST(SceneFileMessages, NameTheLineTheKeyAndTheAllowedValues) {
  EXPECT_EQ(failure("[atmosphere]\n\nmie_gg = 0.5\n"),
            "s.toml:3: unknown parameter 'atmosphere.mie_gg'; did you mean 'atmosphere.mie_g'?");
  EXPECT_EQ(failure("[atmosphre]\nmie_g = 0.5\n"), "s.toml:1: unknown table [atmosphre]; did you mean [atmosphere]?");
  EXPECT_EQ(failure("yaw_deg = 0.5\n"),
            "s.toml:1: unknown parameter 'yaw_deg'; did you mean 'camera.yaw_deg' or 'meshes.yaw_deg'?");
  EXPECT_EQ(failure("fov_deg = 50.0\n"), "s.toml:1: unknown parameter 'fov_deg'; did you mean 'camera.fov_deg'?");
  EXPECT_EQ(failure("camera = 0.5\n"), "s.toml:1: 'camera' is a number; expected a table");
  EXPECT_EQ(failure("[[camera]]\nyaw_deg = 0.5\n"), "s.toml:1: 'camera' is an array; expected a table");
  EXPECT_EQ(failure("[camera]\nyaw_deg = 'north'\n"),
            "s.toml:2: 'camera.yaw_deg' is a string; expected -3600 to 3600 deg");
  EXPECT_EQ(failure("[camera]\nfov_deg = 171\n"),
            "s.toml:2: 'camera.fov_deg' = '171' is out of range; expected 1 to 170 deg");
  EXPECT_EQ(failure("[camera]\nfov_deg = nan\n"),
            "s.toml:2: 'camera.fov_deg' = 'nan' is not a finite number; expected 1 to 170 deg");
  EXPECT_EQ(failure("[camera]\nfov_deg = 1e300\n"),
            "s.toml:2: 'camera.fov_deg' = '1e+300' is out of range; expected 1 to 170 deg");
  EXPECT_EQ(failure("[camera]\nposition_m = [1, 2]\n"),
            "s.toml:2: 'camera.position_m' = '2 values' is not 3 numbers; expected 3 numbers, each -1e+09 to "
            "1e+09 m");
  EXPECT_EQ(failure("[camera]\nposition_m = 1\n"),
            "s.toml:2: 'camera.position_m' is a whole number; expected 3 numbers, each -1e+09 to 1e+09 m");
  EXPECT_EQ(failure("[camera]\nposition_m = [1, 2, [3]]\n"),
            "s.toml:2: 'camera.position_m' is an array; expected 3 numbers, each -1e+09 to 1e+09 m");
  EXPECT_EQ(failure("[shadows]\ncascades = 3.0\n"),
            "s.toml:2: 'shadows.cascades' is a number; expected a whole number, 1 to 8 cascades");
  EXPECT_EQ(failure("[shadows]\nsmooth = 1\n"), "s.toml:2: 'shadows.smooth' is a whole number; expected true or false");
  EXPECT_EQ(failure("[shadows]\nsmooth = 1979-05-27\n"),
            "s.toml:2: 'shadows.smooth' is a date or time; expected true or false");
  EXPECT_EQ(failure("[terrain]\nshading = 'shiny'\n"),
            "s.toml:2: 'terrain.shading' = 'shiny' is not one of its values; expected materials, height, plain");
  EXPECT_EQ(failure("[terrain]\nsource = \"a\\u0000b\"\n"),
            "s.toml:2: 'terrain.source' = 'a?b' contains control characters; expected text in UTF-8");
  EXPECT_EQ(failure("[camera.yaw_deg]\n"), "s.toml:1: 'camera.yaw_deg' is a table; expected -3600 to 3600 deg");
  EXPECT_EQ(failure("[camera]\n\"yaw.deg\" = 1\n").substr(0, 45), "s.toml:2: unknown parameter 'camera.yaw.deg';");
}

TEST(SceneFileMessages, BrokenTomlIsOneLineWithItsPlace) {
  const std::string truncated = to_toml(Settings()).substr(0, 1200);
  const std::string_view broken[] = {"[camera]\nyaw_deg = 1\n[camera]\npitch_deg = 2\n",
                                     "[camera]\nyaw_deg = 1\nyaw_deg = 2\n",
                                     "[camera\n",
                                     "[camera]\nyaw_deg = \n",
                                     "[camera]\nposition_m = [1, 2,",
                                     "= 3",
                                     "<?xml version='1.0'?>",
                                     "\x01\x02\x03\x04"};
  for (const std::string_view text : broken) {
    const std::string message = failure(text);
    EXPECT_EQ(message.rfind("s.toml:", 0), 0U) << message;
    EXPECT_NE(message.find(": not valid TOML: "), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_NE(failure(std::string(100000, '[')), "(accepted)");
  EXPECT_EQ(failure("[terrain]\nsource = '\xff'\n"), "s.toml: not a text file; expected a scene file: TOML in UTF-8");
}

// Every prefix of a complete scene file is loaded or rejected with one line, without a crash.
TEST(SceneFileMessages, EveryTruncationIsHandled) {
  const std::string whole = to_toml(Settings());
  int refused = 0;
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    const std::string message = failure(whole.substr(0, length));
    if (message == "(accepted)") continue;
    ++refused;
    EXPECT_NE(message.find("s.toml:"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_GT(refused, 0);
}

TEST_F(SceneFile, AFailedLoadChangesNothing) {
  Settings settings;
  EXPECT_FALSE(load_text(settings, "[sun]\nelevation_deg = 3\n[camera]\nfov_deg = 0\n", "s").ok());
  EXPECT_EQ(all_text(settings), all_text(Settings()));
}

TEST_F(SceneFile, UnreadableFiles) {
  Settings settings;
  const Result<void> missing = load(settings, (directory_ / "none.toml").string());
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::io);
  EXPECT_NE(missing.error().message.find("none.toml': cannot read: No such file or directory"), std::string::npos);
  const Result<void> directory = load(settings, directory_.string());
  ASSERT_FALSE(directory.ok());
  EXPECT_NE(directory.error().message.find("Is a directory"), std::string::npos);
  const Result<void> huge = load(settings, write("huge.toml", std::string((1U << 20U) + 1, '#')));
  ASSERT_FALSE(huge.ok());
  EXPECT_NE(huge.error().message.find("at most 1048576 bytes"), std::string::npos);
  EXPECT_TRUE(load(settings, write("empty.toml", "")).ok());
}

TEST_F(SceneFile, TheSunIsGreyOrAColour) {
  Settings settings;
  ASSERT_TRUE(load(settings, write("grey.toml", "[sun]\nirradiance = 40\n")).ok());
  EXPECT_EQ(settings.scene.sun.irradiance, Vec3(40.0F));
  ASSERT_TRUE(load(settings, write("colour.toml", "[sun]\nirradiance = [1.5, 2, 0.25]\n")).ok());
  EXPECT_EQ(settings.scene.sun.irradiance, Vec3(1.5F, 2.0F, 0.25F));
  EXPECT_FALSE(load(settings, write("two.toml", "[sun]\nirradiance = [1.5, 2.0]\n")).ok());
  EXPECT_FALSE(load(settings, write("place.toml", "[camera]\nposition_m = 3.0\n")).ok());
}

TEST_F(SceneFile, IncludedFilesAreReadFirst) {
  std::filesystem::create_directory(directory_ / "air");
  write("air/dem.tif", "x");
  write("air/haze.toml", "include = 'base.toml'\n[atmosphere]\nvisibility_m = 9000\n[terrain]\nsource = 'dem.tif'\n");
  write("air/base.toml", "[atmosphere]\nvisibility_m = 1\nmie_g = 0.5\n");
  write("sun.toml", "[sun]\nelevation_deg = 9\nazimuth_deg = 30\n");
  Settings settings;
  // The values of the file itself win, wherever `include` stands.
  const Result<void> loaded =
      load(settings,
           write("s.toml", "camera.yaw_deg = 1\nsun.elevation_deg = 3\ninclude = ['air/haze.toml', 'sun.toml']\n"));
  ASSERT_TRUE(loaded.ok()) << loaded.error().message;
  EXPECT_EQ(settings.effect.atmosphere.visibility_m, 9000.0F);
  EXPECT_EQ(settings.effect.atmosphere.mie_g, 0.5F);
  EXPECT_EQ(settings.scene.sun.elevation_deg, 3.0F);
  EXPECT_EQ(settings.scene.sun.azimuth_deg, 30.0F);
  EXPECT_EQ(settings.scene.terrain.source, (directory_ / "air/dem.tif").string());
}

TEST_F(SceneFile, IncludesFollowLinksBeforeDots) {
  std::filesystem::create_directories(directory_ / "a/b");
  write("a/air.toml", "[atmosphere]\nmie_g = 0.5\n");
  std::filesystem::create_directory_symlink(directory_ / "a/b", directory_ / "link");
  Settings settings;
  ASSERT_TRUE(load(settings, write("s.toml", "include = 'link/../air.toml'\n")).ok());
  EXPECT_EQ(settings.effect.atmosphere.mie_g, 0.5F);
}

TEST_F(SceneFile, WrongIncludesAreRefused) {
  Settings settings;
  const auto refused = [&](std::string_view toml, std::string_view part) {
    const Result<void> loaded = load(settings, write("s.toml", toml));
    ASSERT_FALSE(loaded.ok()) << toml;
    EXPECT_NE(loaded.error().message.find(part), std::string::npos) << loaded.error().message;
  };
  refused("include = 's.toml'\n", "s.toml:1: 's.toml' includes itself; expected files that do not");
  write("t.toml", "\ninclude = './s.toml'\n");
  refused("include = 't.toml'\n", "t.toml:2: './s.toml' includes itself");
  refused("include = 3\n", "s.toml:1: 'include' does not name a file; expected \"FILE.toml\"");
  refused("include = ['']\n", "does not name a file");
  refused("include = 'none.toml'\n", "s.toml:1: 'none.toml' does not exist");
  write("bad.toml", "[atmosphere]\nmie_gg = 1\n");
  for (int i = 0; i < 9; ++i) {
    write("chain" + std::to_string(i) + ".toml", "include = 'chain" + std::to_string(i + 1) + ".toml'\n");
  }
  refused("include = 'chain0.toml'\n", "too many files include each other; expected at most 8 files in a chain");
  std::string many = "include = [";
  for (int i = 0; i < 70; ++i) many += "'empty.toml', ";
  write("empty.toml", "");
  refused(many + "]\n", "64 in all");
  EXPECT_EQ(failure("include = 's.toml'\n"), "s.toml:1: 'include' needs a file; expected a scene without it");
  // Nothing of a file is used if one that it includes is wrong.
  refused("include = 'bad.toml'\n[sun]\nelevation_deg = 80\n", "bad.toml:2: unknown parameter 'atmosphere.mie_gg'");
  EXPECT_EQ(all_text(settings), all_text(Settings()));
}

// A scene cannot make the program read or write files outside of the folder of the scene, or use a network.
TEST_F(SceneFile, ScenesStayInTheirFolder) {
  const std::filesystem::path inside = directory_ / "scene";
  std::filesystem::create_directories(inside / "air");
  write("secret.toml", "[sun]\nelevation_deg = 3\n");
  write("scene/air/a.toml", "include = '../b.toml'\n");
  write("scene/b.toml", "[sun]\nelevation_deg = 4\n");
  std::filesystem::create_symlink(directory_ / "secret.toml", inside / "link.toml");
  std::filesystem::create_directory_symlink(directory_, inside / "folder");
  std::filesystem::create_symlink(inside / "air", inside / "elsewhere");
  const std::string secret = (directory_ / "secret.toml").string();
  const auto text_of = [&](const std::string& toml) {
    Settings settings;
    const Result<void> loaded = load(settings, write("scene/s.toml", toml));
    return loaded.ok() ? std::string() : loaded.error().message;
  };
  const std::vector<std::pair<std::string, std::string>> refused = {
      {"include = '../secret.toml'\n", "s.toml:1: '../secret.toml' is outside the folder of the scene; expected"},
      {"\ninclude = ['b.toml', '" + secret + "']\n", "s.toml:2: '" + secret + "' is outside"},
      {"include = 'link.toml'\n", "'link.toml' is outside"},
      {"include = 'folder/secret.toml'\n", "'folder/secret.toml' is outside"},
      {"include = 'air/../../secret.toml'\n", "is outside"},
      {"include = '../none.toml'\n", "is outside"},
      {"[terrain]\nsource = '/vsicurl/http://example.invalid/a.tif'\n", "is on a network; expected a local file"},
      {"[terrain]\nsource = '/vsizip//vsicurl/http://example.invalid/a.zip/a.tif'\n", "is on a network"},
      {"[terrain]\nsource = 'NETCDF:http://example.invalid/a:z'\n", "is on a network"},
      {"[tables]\ncache = '" + (directory_ / "new").string() + "'\n", "is outside the folder of the scene; expected"},
  };
  for (const auto& [toml, part] : refused) {
    EXPECT_NE(text_of(toml).find(part), std::string::npos) << toml << text_of(toml);
    EXPECT_NE(text_of(toml).find("or --allow-outside"), std::string::npos) << text_of(toml);
  }
  // Tables that a parameter names.
  for (const Row& row : rows()) {
    if (row.info.type != ParamType::string || row.info.unit != "file" || row.info.name == "source") continue;
    const auto toml = [&](const std::string& file) {
      return "[" + std::string(row.info.group) + "]\n" + std::string(row.info.name) + " = '" + file + "'\n";
    };
    EXPECT_NE(text_of(toml(secret)).find("is outside the folder of the scene"), std::string::npos) << row.key();
    EXPECT_NE(text_of(toml("../secret.toml")).find("is outside"), std::string::npos) << row.key();
    EXPECT_NE(text_of(toml("link.toml")).find("is outside"), std::string::npos) << row.key();
    EXPECT_EQ(text_of(toml("b.toml")), "") << row.key();
  }
  const std::string empty = (directory_ / "empty").string();
  std::filesystem::create_directory(empty);
  EXPECT_EQ(text_of("[tables]\ncache = '" + empty + "'\n"), "");
  EXPECT_NE(text_of("[tables]\ncache = '" + directory_.string() + "'\n"), "");
  write("used.cache", "x");  // now the folder is a cache already
  for (const std::string& toml :
       {std::string("include = 'air/a.toml'\n"), std::string("include = 'elsewhere/a.toml'\n"),
        "include = '" + (inside / "b.toml").string() + "'\n", "[tables]\ncache = '" + (inside / "new").string() + "'\n",
        std::string("[tables]\ncache = 'off'\n"), "[tables]\ncache = '" + directory_.string() + "'\n",
        std::string("[terrain]\nsource = '/vsizip/a.zip/a.tif'\n")}) {
    EXPECT_EQ(text_of(toml), "") << toml;
  }
  // Run in a separate process, because allow_outside() applies to the whole process.
  const auto allowed = [&] {
    files::allow_outside();
    bool all = true;
    for (const auto& [toml, part] : refused) all = all && text_of(toml).find("outside") == std::string::npos;
    return all;
  };
  EXPECT_EXIT(std::exit(allowed() ? 0 : 1), testing::ExitedWithCode(0), "");
}

TEST_F(SceneFile, FilesAreFoundBesideTheScene) {
  write("dem.tif", "x");
  Settings settings;
  ASSERT_TRUE(load(settings, write("s.toml", "[terrain]\nsource = 'dem.tif'\n")).ok());
  EXPECT_EQ(settings.scene.terrain.source, (directory_ / "dem.tif").string());
  ASSERT_TRUE(load(settings, write("s.toml", "[terrain]\nsource = 'elsewhere.tif'\n")).ok());
  EXPECT_EQ(settings.scene.terrain.source, "elsewhere.tif");
  write("procedural", "x");
  ASSERT_TRUE(load(settings, write("s.toml", "[terrain]\nsource = 'procedural'\n")).ok());
  EXPECT_EQ(settings.scene.terrain.source, "procedural");
}

TEST(Describe, MarkdownHasOneRowPerParameter) {
  const std::string page = to_markdown();
  for (const Row& row : rows()) EXPECT_NE(page.find("| `" + row.key() + "` |"), std::string::npos) << row.key();
}

// Each part of a dotted key is a table inside the previous one: forty thousand of them would overflow the parser's
// stack.
TEST(ConfigSceneFile, KeysOfManyPartsAreRefused) {
  std::string dots = "a";
  for (int i = 0; i < 40000; ++i) dots += ".a";
  std::string spaced = "a";
  for (int i = 0; i < 40000; ++i) spaced += " . \"b\"";
  for (const std::string& text : {"\n" + dots + " = 1\n", "\n[" + dots + "]\n", "\n[[" + dots + "]]\n",
                                  "\n" + spaced + "=1", "\ncamera = { " + dots + " = 1 }"}) {
    Settings settings;
    const Result<void> read = load_text(settings, text, "deep.toml");
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().message, "deep.toml:2: a key of more than 16 parts; expected KEY = VALUE in [TABLES]");
  }
  Settings settings;
  const std::string quoted =
      "# " + dots + "\n[terrain]\nsource = \"" + dots + "\"\n[meshes]\nsource = '''" + dots + "'''\n";
  const Result<void> read = load_text(settings, quoted, "quoted.toml");
  EXPECT_TRUE(read.ok()) << read.error().message;
}

}  // namespace
}  // namespace tyndall::config
