// The options common to all verbs, tested without the executable.
#include <gtest/gtest.h>

#include <filesystem>

#include "arguments.hpp"
#include "cli.hpp"
#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

TEST(CliOptions, Sizes) {
  for (const auto& [text, width, height] :
       {std::tuple("1x1", 1U, 1U), std::tuple("1280x720", 1280U, 720U), std::tuple("16384x16384", 16384U, 16384U)}) {
    const Result<Size> size = parse_size(text, "--size");
    ASSERT_TRUE(size.ok()) << text;
    EXPECT_EQ(size.value().width, width);
    EXPECT_EQ(size.value().height, height);
  }
  for (const char* const text : {"0x0", "0x5", "100000x100000", "16385x1", "-1x5", "12", "12x", "x12", "1x2x3", "axb",
                                 "", "1.5x2", "1e3x2", "18446744073709551617x1"}) {
    const Result<Size> size = parse_size(text, "--size");
    ASSERT_FALSE(size.ok()) << text;
    EXPECT_EQ(size.error().message,
              std::string("--size: invalid size '").append(text) + "'; expected WIDTHxHEIGHT, each 1 to 16384");
  }
}

// `sky` draws no picture of the scene either.
TEST(CliOptions, AssignmentsWithoutEffectOnSkiesAreNoted) {
  const Scratch scratch;
  const auto notes = [&](const std::string& assignment) {
    return run_tyndall({"sky", "-o", scratch.at("sky.exr"), "--size", "4x2", "--model", "single", "--disc", "false",
                        "--sun-elevation-deg", "30", "--sun-azimuth-deg", "0", "--set", assignment})
        .err;
  };
  EXPECT_EQ(notes("sun.irradiance=2,2,2"), "");
  EXPECT_EQ(notes("sun.elevation_deg=70"),
            "tyndall: note: sun.elevation_deg has no effect here, where no picture is drawn\n");
  EXPECT_EQ(notes(" camera.altitude_m =9000"),
            "tyndall: note: camera.altitude_m has no effect here, where no picture is drawn\n");
  EXPECT_EQ(
      notes("scattering.medium=homogeneous"),
      "tyndall: note: scattering.medium = homogeneous has no effect here; --model homogeneous-medium computes this "
      "model\n");
}

TEST(CliOptions, FramePaths) {
  EXPECT_EQ(frame_path("out.%04d.png", 7), "out.0007.png");
  EXPECT_EQ(frame_path("out.%04d.png", 123456), "out.123456.png");
  EXPECT_EQ(frame_path("%d.exr", 12), "12.exr");
  EXPECT_EQ(frame_path("100%.png", 3), "100%.png");
  EXPECT_EQ(frame_path("%s%n%04x.png", 3), "%s%n%04x.png");
}

TEST(CliOptions, Outputs) {
  const Scratch scratch;
  CommonOptions options;
  const auto message = [&](const std::string& output, std::uint32_t frames) {
    options.output = output;
    options.frames = frames;
    const Result<void> checked = check_output(options, {".png", ".exr"});
    return checked ? std::string("fine") : checked.error().message;
  };
  EXPECT_EQ(message("", 1), "-o: no output file; expected -o FILE with a name that ends in .png or .exr");
  EXPECT_EQ(message("a.jpg", 1), "-o: unknown format 'a.jpg'; expected a name that ends in .png or .exr");
  EXPECT_EQ(message(scratch.at("a.PNG"), 1), "fine");
  EXPECT_EQ(message("a.png", 2),
            "-o: 2 frames in one file 'a.png'; expected one frame number in the name, as in out.%04d.png");
  EXPECT_EQ(message("%d.%d.png", 2),
            "-o: 2 frames in one file '%d.%d.png'; expected one frame number in the name, as in out.%04d.png");
  EXPECT_EQ(message(scratch.at("a.%04d.png"), 2), "fine");
  EXPECT_NE(message(scratch.at("none/a.png"), 1).find("No such file or directory"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(scratch.at("")));
}

TEST(CliOptions, EveryCommonOption) {
  CommonOptions options;
  Arguments arguments("params");
  add_common(arguments, options, kScene | kSet | kDevice | kSize | kFrames | kOutput | kJson);
  const std::vector<std::string> given = {"--set",   "sun.azimuth_deg=-3", "scene.toml", "--set", "b=2",    "-o",
                                          "out.png", "--size=3x4",         "--frames",   "9",     "--json", "--device",
                                          "llvm"};
  EXPECT_EQ(arguments.parse(given), std::nullopt);
  EXPECT_EQ(options.scene_file, "scene.toml");
  EXPECT_EQ(options.sets, (std::vector<std::string>{"sun.azimuth_deg=-3", "b=2"}));
  EXPECT_EQ(options.output, "out.png");
  EXPECT_EQ(options.size.width, 3U);
  EXPECT_EQ(options.size.height, 4U);
  EXPECT_EQ(options.frames, 9U);
  EXPECT_EQ(options.device, "llvm");
  EXPECT_TRUE(options.json);
}

TEST(CliOptions, NumbersMayBeNegative) {
  double elevation_deg = 0.0;
  std::string place;
  Arguments arguments("params");
  arguments.number("--sun-elevation-deg", elevation_deg, -90.0, 90.0, "");
  arguments.text("--at", place, "LAT,LON", "");
  const std::vector<std::string> given = {"--sun-elevation-deg", "-3.5", "--at", "-33.9,151.2"};
  EXPECT_EQ(arguments.parse(given), std::nullopt);
  EXPECT_EQ(elevation_deg, -3.5);
  EXPECT_EQ(place, "-33.9,151.2");
}

TEST(CliOptions, SceneFilesThatCannotBeReadAreBadInput) {
  CommonOptions options;
  options.scene_file = "/nonexistent.toml";
  const Result<void> resolved = resolve(options);
  ASSERT_FALSE(resolved.ok());
  EXPECT_EQ(resolved.error().code, ErrorCode::invalid_argument);
}

}  // namespace
}  // namespace tyndall::cli
