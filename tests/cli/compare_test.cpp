// `tyndall compare` on small generated images.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "image/image.hpp"
#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

class CliCompare : public testing::Test {
 protected:
  // Writes a PNG whose values are `level` of 255, and `level + 1` in every fourth row.
  std::string png(const std::string& name, int level, std::uint32_t width = 16) const {
    image::Image picture(width, 16);
    for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
      const bool fourth = i / (std::size_t{3} * width) % 4 == 0;
      picture.rgb[i] = static_cast<float>(level + (fourth ? 1 : 0)) / 255.0F;
    }
    EXPECT_TRUE(image::write_png(scratch_.at(name), picture, {}, {image::Encoding::srgb, false}).ok());
    return scratch_.at(name);
  }
  std::string exr(const std::string& name, float value) const {
    image::Image picture(16, 16);
    for (float& entry : picture.rgb) entry = value;
    EXPECT_TRUE(image::write_exr(scratch_.at(name), picture, {}).ok());
    return scratch_.at(name);
  }

  Scratch scratch_;
};

TEST_F(CliCompare, EqualImages) {
  const ProcessResult process =
      run_tyndall({"compare", png("a.png", 100), png("b.png", 100), "--json", "--psnr-min", "90"});
  ASSERT_EQ(process.status, 0) << process.err;
  const nlohmann::json result = nlohmann::json::parse(process.out);
  EXPECT_EQ(result["rmse"], 0.0);
  EXPECT_EQ(result["psnr_db"], 999.0);
  EXPECT_EQ(result["mean_relative_error"], 0.0);
  EXPECT_EQ(result["max_abs"], 0.0);
  EXPECT_EQ(result["within"], true);
}

TEST_F(CliCompare, LimitsDecideTheStatus) {
  const std::string a = png("a.png", 102);
  const std::string b = png("b.png", 100);
  const ProcessResult plain = run_tyndall({"compare", a, b, "--json"});
  ASSERT_EQ(plain.status, 0) << plain.err;
  const nlohmann::json result = nlohmann::json::parse(plain.out);
  const double psnr_db = 20.0 * std::log10(255.0 / 2.0);
  EXPECT_NEAR(result["psnr_db"].get<double>(), psnr_db, 1e-4);
  EXPECT_NEAR(result["max_abs"].get<double>(), 2.0 / 255.0, 1e-7);
  EXPECT_NEAR(result["mean_relative_error"].get<double>(), 0.75 * 2.0 / 100.0 + 0.25 * 2.0 / 101.0, 1e-6);

  EXPECT_EQ(run_tyndall({"compare", a, b, "--psnr-min", "42", "--mre-max", "0.02"}).status, 0);
  const ProcessResult low = run_tyndall({"compare", a, b, "--psnr-min", "42.2"});
  EXPECT_EQ(low.status, 2);
  EXPECT_EQ(low.err.rfind("tyndall: error: --psnr-min: psnr_db is 42.1", 0), 0U) << low.err;
  EXPECT_NE(low.out.find("rmse 0.0078"), std::string::npos) << low.out;
  EXPECT_EQ(run_tyndall({"compare", a, b, "--mre-max", "0.0199"}).status, 2);
}

TEST_F(CliCompare, ExrIsComparedInLinearValues) {
  const ProcessResult process = run_tyndall({"compare", exr("a.exr", 101.0F), exr("b.exr", 100.0F), "--json"});
  ASSERT_EQ(process.status, 0) << process.err;
  const nlohmann::json result = nlohmann::json::parse(process.out);
  EXPECT_NEAR(result["mean_relative_error"].get<double>(), 0.01, 1e-12);
  EXPECT_NEAR(result["rmse"].get<double>(), 1.0, 1e-12);
  EXPECT_EQ(result["kind"], "exr");
}

TEST_F(CliCompare, NotFiniteIsBeyondAnyLimit) {
  const std::string bad = exr("a.exr", std::numeric_limits<float>::quiet_NaN());
  const ProcessResult process = run_tyndall({"compare", bad, bad, "--json"});
  EXPECT_EQ(process.status, 2);
  EXPECT_EQ(nlohmann::json::parse(process.out)["non_finite"], nlohmann::json({768, 768}));
  EXPECT_EQ(process.err,
            "tyndall: error: tyndall compare: 768 values in A and 768 in B are not finite; expected none\n");
}

TEST_F(CliCompare, OtherSizesKindsAndUnreadableFilesAreErrors) {
  const std::string a = png("a.png", 100);
  const ProcessResult sizes = run_tyndall({"compare", a, png("b.png", 100, 17)});
  EXPECT_EQ(sizes.status, 3);
  EXPECT_EQ(sizes.err, "tyndall: error: tyndall compare: A is 16x16 and B is 17x16; expected equal sizes\n");
  EXPECT_EQ(run_tyndall({"compare", a, exr("b.exr", 1.0F)}).status, 4);
  EXPECT_EQ(run_tyndall({"compare", a, scratch_.at("none.png")}).status, 4);
  EXPECT_EQ(run_tyndall({"compare", scratch_.write("text.png", "no image"), a}).status, 4);
  const std::string whole = contents_of(a);
  const ProcessResult cut = run_tyndall({"compare", a, scratch_.write("cut.png", whole.substr(0, whole.size() / 2))});
  EXPECT_EQ(cut.status, 4);
  EXPECT_EQ(std::count(cut.err.begin(), cut.err.end(), '\n'), 1) << cut.err;
  EXPECT_EQ(cut.out, "");
}

TEST_F(CliCompare, TheDifferenceIsWritten) {
  const std::string a = png("a.png", 105);
  const std::string b = png("b.png", 100);
  ASSERT_EQ(run_tyndall({"compare", a, b, "--diff", scratch_.at("d.png")}).status, 0);
  const Result<image::File> shown = image::read(scratch_.at("d.png"));
  ASSERT_TRUE(shown.ok()) << shown.error().message;
  for (const float value : shown.value().image.rgb) ASSERT_FLOAT_EQ(value, 80.0F / 255.0F);
  EXPECT_EQ(run_tyndall({"compare", a, b, "--diff", scratch_.at("none/d.png")}).status, 1);
}

TEST_F(CliCompare, TheDifferenceIsNotWrittenOverAnInput) {
  const std::string a = png("a.png", 105);
  const std::string b = png("b.png", 100);
  const std::string before = contents_of(b);
  std::filesystem::create_hard_link(b, scratch_.at("same.png"));
  std::filesystem::create_symlink(b, scratch_.at("link.png"));
  for (const std::string& path : {b, scratch_.at("same.png"), scratch_.at("link.png"), scratch_.at("./b.png")}) {
    const ProcessResult process = run_tyndall({"compare", a, b, "--diff", path});
    EXPECT_EQ(process.status, 2) << path;
    EXPECT_NE(process.err.find("is B of this run; expected a file that is not an input"), std::string::npos)
        << process.err;
    EXPECT_EQ(contents_of(b), before);
  }
}

TEST_F(CliCompare, HelpListsTheExitStatuses) {
  std::string help = run_tyndall({"compare", "--help"}).out;
  std::replace(help.begin(), help.end(), '\n', ' ');  // lines may end anywhere
  EXPECT_NE(help.find("3 if the sizes differ; 4 if a file cannot be read"), std::string::npos) << help;
}

}  // namespace
}  // namespace tyndall::cli
