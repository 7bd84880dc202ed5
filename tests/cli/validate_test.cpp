// `tyndall validate` with few rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

const std::vector<std::string> kSmall = {"--rays", "36", "--samples", "300", "--orders", "3", "--seed", "7"};

class CliValidate : public testing::Test {
 protected:
  static ProcessResult run(std::vector<std::string> more) {
    more.insert(more.begin(), kSmall.begin(), kSmall.end());
    more.insert(more.begin(), "validate");
    return run_tyndall(more);
  }
  Scratch scratch_;
};

TEST_F(CliValidate, ReportsAndPagesAreTheSameEveryTime) {
  const std::string html = scratch_.at("report.html");
  const std::string page = scratch_.at("page.md");
  // Small tables are enough to test the report.
  const ProcessResult process = run(
      {"-o", html, "--markdown", page, "--json", "--set", "atmosphere.mie_g=0.7", "--set", "tables.size=8,32,32,4"});
  ASSERT_EQ(process.status, 0) << process.err;
  EXPECT_EQ(process.err, "");
  const nlohmann::json json = nlohmann::json::parse(process.out);
  const std::string command = "tyndall validate -o REPORT.html --rays 36 --samples 300 --seed 7 --orders 3 --set "
                              "atmosphere.mie_g=0.7 --set tables.size=8,32,32,4";
  EXPECT_EQ(json["command"], command);
  EXPECT_NE(contents_of(html).find(command), std::string::npos);
  EXPECT_NE(contents_of(page).find("    " + command + "\n"), std::string::npos);
  EXPECT_NE(contents_of(page).find(json["device"].get<std::string>()), std::string::npos);
  bool found = false;
  for (const nlohmann::json& model : json["models"]) {
    if (model["name"] != "single") continue;
    for (const nlohmann::json& group : model["groups"]) {
      if (group["sun"] != "up" || group["region"] != "all") continue;
      found = true;
      // Single scattering is exact, so the difference is the noise of 300 paths.
      EXPECT_LT(group["mean"].get<double>(), 2.0 * group["noise"].get<double>() + 0.002);
    }
  }
  EXPECT_TRUE(found);
  const std::string first_html = contents_of(html);
  const std::string first_page = contents_of(page);
  ASSERT_EQ(
      run({"-o", html, "--markdown", page, "--set", "atmosphere.mie_g=0.7", "--set", "tables.size=8,32,32,4"}).status,
      0);
  EXPECT_EQ(contents_of(html), first_html);
  EXPECT_EQ(contents_of(page), first_page);
}

TEST_F(CliValidate, ErrorsAreReported) {
  const auto error = [&](const std::vector<std::string>& arguments, int status = 2) {
    const ProcessResult process = run(arguments);
    EXPECT_EQ(process.status, status) << process.err;
    EXPECT_EQ(std::count(process.err.begin(), process.err.end(), '\n'), 1);
    return process.err;
  };
  EXPECT_EQ(error({}), "tyndall: error: -o: no output file; expected -o REPORT.html, --markdown FILE or --json\n");
  EXPECT_NE(error({"-o", scratch_.at("a.pdf")}).find("expected a name that ends in .html or .htm"), std::string::npos);
  EXPECT_NE(error({"--markdown", scratch_.at("a.txt")}).find("expected a name that ends in .md"), std::string::npos);
  EXPECT_NE(error({"-o", scratch_.at("no/a.html")}, 1).find("No such file or directory"), std::string::npos);
  const ProcessResult few = run_tyndall({"validate", "--json", "--rays", "3"});
  EXPECT_EQ(few.status, 2);
  EXPECT_NE(few.err.find("--rays: invalid count '3'; expected a whole number, 18 to"), std::string::npos);
}

}  // namespace
}  // namespace tyndall::cli
