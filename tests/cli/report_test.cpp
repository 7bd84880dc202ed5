// `tyndall report` in its short form: the values of this device are computed first, one of them is falsified, and the
// report finds it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "../sanitizers.hpp"
#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

const nlohmann::json* find(const nlohmann::json& list, const char* key, const std::string& part) {
  for (const nlohmann::json& one : list) {
    if (one[key].get<std::string>().find(part) != std::string::npos) return &one;
  }
  return nullptr;
}

// Doubles the red radiance of every result.
std::string falsified(const std::string& csv) {
  std::istringstream in(csv);
  std::string out;
  std::size_t column = 0;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, ',');) fields.push_back(field);
    if (out.empty()) {
      column = static_cast<std::size_t>(std::find(fields.begin(), fields.end(), "L_r") - fields.begin());
    } else {
      fields[column] = std::to_string(2.0 * std::stod(fields[column]));
    }
    for (std::size_t i = 0; i < fields.size(); ++i) out += (i == 0 ? "" : ",") + fields[i];
    out += "\n";
  }
  return out;
}

TEST(Report, ComparesTheDeviceWithReferenceValuesAndMeasuresIt) {
  const Scratch scratch;
  const std::string data = scratch.at("data");
  std::filesystem::create_directories(data);
  std::filesystem::create_directory_symlink(TYNDALL_SCENES, data + "/scenes");
  const ProcessResult reference = run_tyndall({"report", "--short", "--reference", "--data", data});
  ASSERT_EQ(reference.status, 0) << reference.err;
  const std::string single = data + "/report/single.csv";
  const std::string wrong = falsified(contents_of(single));
  std::ofstream(single, std::ios::binary) << wrong;

  const std::string folder = scratch.at("report");
  const ProcessResult made = run_tyndall({"report", "--short", "--data", data, "-o", folder, "--seconds", "600"});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(made.err, "");
  EXPECT_FALSE(std::filesystem::exists(folder + ".part"));
  EXPECT_FALSE(std::filesystem::exists(folder + "/work"));
  const nlohmann::json report = nlohmann::json::parse(contents_of(folder + "/report.json"));
  EXPECT_EQ(report["device"]["used"], true);
  for (const auto& [name, passed] : {std::pair{"model precomputed", true},
                                     {"model single", false},
                                     {"scene hall", true},
                                     {"same bytes", true},
                                     {"with and without the tree", true},
                                     {"validation layer", true}}) {
    const nlohmann::json* const check = find(report["checks"], "name", name);
    ASSERT_NE(check, nullptr) << name << "\n" << report["left_out"].dump(1);
    EXPECT_EQ((*check)["passed"], passed) << check->dump(1);
  }
  EXPECT_EQ((*find(report["checks"], "name", "model precomputed"))["values"]["mean_relative_difference"], 0.0);
  EXPECT_GT((*find(report["checks"], "name", "model single"))["values"]["mean_relative_difference"], 0.05);
  EXPECT_NE(find(report["checks"], "name", "against brute force"), nullptr);

  EXPECT_GT(report["tables"]["stages"].size(), 3U);
  ASSERT_GE(report["times"].size(), 2U) << report["left_out"].dump(1);
  for (const nlohmann::json& times : report["times"]) {
    EXPECT_GT(times["effect_ms"], 0.0);
    EXPECT_GT(times["floor_ms"], 0.0);
    EXPECT_GT(times["frames"], 0);
  }
  // The CPU device has neither; a device that has them reports them instead.
  for (const auto& [part, present] : {std::pair{"registers, spills and code sizes", report.contains("pipelines")},
                                      {"clocks", report.contains("clocks")}}) {
    EXPECT_NE(find(report["left_out"], "part", part) != nullptr, present) << part;
  }
  // The page shows the same results. Neither the page nor report.json names folders of this machine.
  const std::string page = contents_of(folder + "/index.html");
  EXPECT_NE(page.find("<b class=bad>failed</b>"), std::string::npos);
  EXPECT_NE(page.find(report["device"]["name"].get<std::string>()), std::string::npos);
  for (const std::string& text : {page, contents_of(folder + "/report.json")}) {
    EXPECT_EQ(text.find(data), std::string::npos);
    EXPECT_EQ(text.find(folder), std::string::npos);
  }
}

TEST(Report, LeavesOutWhatDoesNotFinishInTime) {
  const Scratch scratch;
  const std::string data = scratch.at("data");
  std::filesystem::create_directories(data);
  std::filesystem::create_directory_symlink(TYNDALL_SCENES, data + "/scenes");
  const std::string folder = scratch.at("report");
  // Too little for everything, on any CPU device, but enough for its first parts.
  const int seconds = kSanitizers ? 100 : 10;
  const ProcessResult made =
      run_tyndall({"report", "--data", data, "-o", folder, "--seconds", std::to_string(seconds)});
  ASSERT_EQ(made.status, 0) << made.err;
  const nlohmann::json report = nlohmann::json::parse(contents_of(folder + "/report.json"));
  EXPECT_LT(report["seconds"], 2.0 * seconds);
  EXPECT_NE(find(report["left_out"], "why", "no values of the CPU device"), nullptr);
  const bool in_time = report.value("times", nlohmann::json::array()).size() >= 12;
  EXPECT_TRUE(in_time || find(report["left_out"], "why", "no time was left") != nullptr) << report["left_out"].dump(1);
}

TEST(Report, RefusesWhatItCannotUse) {
  const Scratch scratch;
  const std::string data = scratch.at("data");
  std::filesystem::create_directories(data);
  std::filesystem::create_directory_symlink(TYNDALL_SCENES, data + "/scenes");
  expect_one_line(run_tyndall({"report", "--data", data}), 2, "-o: no output folder; expected -o DIR");
  expect_one_line(run_tyndall({"report", "--data", data, "-o", data}), 2, "exists; expected a new folder");
  expect_one_line(run_tyndall({"report", "--data", scratch.at("none"), "-o", scratch.at("new")}), 2,
                  "there is no scenes/demo.toml");
  expect_one_line(run_tyndall({"report", "--data", data, "-o", "/proc/new"}), 1, "cannot create");
  const std::string unfinished = scratch.write("new.part", "the user's");
  expect_one_line(run_tyndall({"report", "--data", data, "-o", scratch.at("new")}), 1, "cannot create");
  EXPECT_EQ(contents_of(unfinished), "the user's");
  expect_one_line(run_tyndall({"report", "--data", data, "-o", scratch.at("new"), "--seconds", "5"}), 2, "--seconds");
}

}  // namespace
}  // namespace tyndall::cli
