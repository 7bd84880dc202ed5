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

}  // namespace
}  // namespace tyndall::cli
