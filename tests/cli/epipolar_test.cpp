// The promised accuracy of epipolar sampling at 1280 x 720: the default scene, fixed exposure, compared with brute
// force with the same shadows.
#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

class CliEpipolar : public testing::Test {
 protected:
  using Arguments = std::vector<std::string>;

  static Arguments preset(const std::string& name) {
    Arguments out;
    out.push_back(TYNDALL_PRESETS "/" + name + ".toml");
    return out;
  }
  // Renders a scene, or the defaults, to a file, and returns its path.
  static std::string picture(const std::string& path, const Arguments& scene, const Arguments& settings) {
    Arguments all = {"render"};
    all.insert(all.end(), scene.begin(), scene.end());
    all.insert(all.end(), {"--size", "1280x720", "--set", "tonemap.auto_exposure=false", "-o", path});
    for (const std::string& setting : settings) all.insert(all.end(), {"--set", setting});
    const ProcessResult result = run_tyndall(all);
    EXPECT_EQ(result.status, 0) << result.err;
    return path;
  }
  void expect_close(const std::string& kind, const Arguments& scene, const Arguments& settings,
                    const Arguments& limit) const {
    Arguments all = {"compare", picture(scratch_.at("epipolar" + kind), scene, settings), brute_force(kind, scene)};
    all.insert(all.end(), limit.begin(), limit.end());
    const ProcessResult result = run_tyndall(all);
    EXPECT_EQ(result.status, 0) << result.err << result.out;
  }

  Scratch scratch_;

 private:
  // Returns the picture that brute force renders of a scene, which tests share.
  static std::string brute_force(const std::string& kind, const Arguments& scene) {
    static const Scratch scratch;
    const std::string name = std::to_string(pictures().size()) + kind;
    std::string& path = pictures()[{kind, scene}];
    if (path.empty()) path = picture(scratch.at(name), scene, {"scattering.technique=brute-force"});
    return path;
  }
  static std::map<std::pair<std::string, Arguments>, std::string>& pictures() {
    static std::map<std::pair<std::string, Arguments>, std::string> all;
    return all;
  }
};

TEST_F(CliEpipolar, DefaultsAreAsCloseAsPromised) {
  expect_close(".png", {}, {}, {"--psnr-min", "52"});
  expect_close(".exr", {}, {}, {"--mre-max", "0.003"});
}

TEST_F(CliEpipolar, HighQualityIsAsCloseAsPromised) {
  expect_close(".png", preset("high_quality"), {}, {"--psnr-min", "56"});
}

TEST_F(CliEpipolar, HighPerformanceIsAsCloseAsPromised) {
  expect_close(".png", preset("high_performance"), {}, {"--psnr-min", "44"});
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
    const ProcessResult result =
        run_tyndall({"render", file, "--size", "320x180", "--frames", std::to_string(suns.size()), "--time-step", "1",
                     "--set", "scattering.technique=" + technique, "-o", scratch_.at(technique + "%d.png")});
    ASSERT_EQ(result.status, 0) << result.err;
  }
  for (std::size_t i = 0; i < suns.size(); ++i) {
    const std::string name = std::to_string(i) + ".png";
    const ProcessResult result = run_tyndall(
        {"compare", scratch_.at("epipolar" + name), scratch_.at("brute-force" + name), "--psnr-min", "52.5"});
    EXPECT_EQ(result.status, 0) << "sun at " << suns[i] << " degrees: " << result.err << result.out;
  }
}

}  // namespace
}  // namespace tyndall::cli
