// The promised accuracy of epipolar sampling at 1280 x 720: the default scene, fixed exposure, compared with brute
// force with the same shadows.
#include <gtest/gtest.h>

#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

class CliEpipolar : public testing::Test {
 protected:
  using Arguments = std::vector<std::string>;

  // Renders a scene, or the defaults.
  std::string picture(const std::string& name, const Arguments& scene, const Arguments& settings) const {
    Arguments all = {"render"};
    all.insert(all.end(), scene.begin(), scene.end());
    all.insert(all.end(), {"--size", "1280x720", "--set", "tonemap.auto_exposure=false", "-o", scratch_.at(name)});
    for (const std::string& setting : settings) all.insert(all.end(), {"--set", setting});
    const Outcome outcome = run_tyndall(all);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return scratch_.at(name);
  }
  void expect_close(const std::string& kind, const Arguments& scene, const Arguments& settings,
                    const Arguments& limit) const {
    Arguments brute = settings;
    brute.emplace_back("scattering.technique=brute-force");
    Arguments all = {"compare", picture("epipolar" + kind, scene, settings), picture("brute" + kind, scene, brute)};
    all.insert(all.end(), limit.begin(), limit.end());
    const Outcome outcome = run_tyndall(all);
    EXPECT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  }

  Scratch scratch_;
};

TEST_F(CliEpipolar, DefaultsAreAsCloseAsPromised) {
  expect_close(".png", {}, {}, {"--psnr-min", "52"});
  expect_close(".exr", {}, {}, {"--mre-max", "0.003"});
}

TEST_F(CliEpipolar, HighQualityIsAsCloseAsPromised) {
  expect_close(".png", {std::string(TYNDALL_PRESETS) + "/high_quality.toml"}, {}, {"--psnr-min", "56"});
}

TEST_F(CliEpipolar, HighPerformanceIsAsCloseAsPromised) {
  expect_close(".png", {std::string(TYNDALL_PRESETS) + "/high_performance.toml"}, {}, {"--psnr-min", "44"});
}

TEST_F(CliEpipolar, TheFewestSlicesAreAsCloseAsPromised) {
  expect_close(".png", {}, {"epipolar.slices=32", "epipolar.samples=32"}, {"--psnr-min", "40"});
}

// Each picture has its own exposure. tools/epipolar_suns.py measures more suns and views.
TEST_F(CliEpipolar, TwilightIsAsCloseAsPromised) {
  std::string scene = "[tonemap]\nauto_exposure = true\nlight_adaptation = false\n";
  const std::vector<int> suns = {4, -7, -9, -12};
  for (std::size_t i = 0; i < suns.size(); ++i) {
    scene += "[[path]]\ntime_s = " + std::to_string(i) +
             ".0\nposition_m = [0.0, 8000.0, 0.0]\nyaw_deg = 5.4\npitch_deg = 8.0\nsun_azimuth_deg = 5.4\n" +
             "sun_elevation_deg = " + std::to_string(suns[i]) + ".0\n";
  }
  const std::string file = scratch_.write("suns.toml", scene);
  for (const std::string technique : {"epipolar", "brute-force"}) {
    const Outcome outcome =
        run_tyndall({"render", file, "--size", "320x180", "--frames", std::to_string(suns.size()), "--time-step", "1",
                     "--set", "scattering.technique=" + technique, "-o", scratch_.at(technique + "%d.png")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  for (std::size_t i = 0; i < suns.size(); ++i) {
    const std::string name = std::to_string(i) + ".png";
    const Outcome outcome = run_tyndall(
        {"compare", scratch_.at("epipolar" + name), scratch_.at("brute-force" + name), "--psnr-min", "52.5"});
    EXPECT_EQ(outcome.status, 0) << "sun at " << suns[i] << " degrees: " << outcome.err << outcome.out;
  }
}

}  // namespace
}  // namespace tyndall::cli
