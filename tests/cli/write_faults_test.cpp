// Tests the program when a call that writes its output fails. It must end with status 1 and one line with the name of
// the output. No incomplete file may have this name, and nothing else may be left after the next run. With
// TYNDALL_WRITE_FAULTS=200, that many faults of every verb are tried, evenly over the run, which takes long. `bench`,
// `devices` and `params` write no files. `report` runs the other verbs and leaves out those that fail.
#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>

#include "faults/write_faults.hpp"
#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kSmall = {"--set", "tables.size=4,16,12,6", "--set", "tables.orders=1"};

constexpr const char* kQueries = "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n0,70,50,3\n1000,20,30,4\n";

class CliWriteFaults : public testing::Test {
 protected:
  void TearDown() override { set_fault(0, 0, ""); }

  static void set(const char* name, const std::string& value) { ::setenv(name, value.c_str(), 1); }
  void set_fault(long at, int error, const std::string& call) const {
    set("TYNDALL_FAULT_FOLDER", scratch_.at("out"));
    set("TYNDALL_FAULT_AT", std::to_string(at));
    set("TYNDALL_FAULT_ERROR", std::to_string(error));
    set("TYNDALL_FAULT_CALL", call);
  }
  static ProcessResult run(const std::vector<std::string>& arguments) {
    set("LD_PRELOAD", TYNDALL_WRITE_FAULTS_LIBRARY);
    ProcessResult process = run_tyndall(arguments);
    ::unsetenv("LD_PRELOAD");
    return process;
  }
  using Files = std::vector<std::pair<std::string, std::string>>;
  // Removes times from a JSON file.
  static void forget_times(nlohmann::json& json) {
    if (json.is_object()) {
      for (const char* const name : {"time", "seconds", "ms", "device_ms", "total_ms", "wall_ms"}) json.erase(name);
    }
    if (!json.is_structured()) return;
    for (nlohmann::json& part : json) forget_times(part);
  }
  // Returns the names and contents of the output, without times.
  [[nodiscard]] Files output() const {
    Files out;
    for (const auto& entry : fs::recursive_directory_iterator(scratch_.at("out"))) {
      std::string contents = entry.is_regular_file() ? contents_of(entry.path().string()) : "";
      if (entry.path().extension() == ".json") {
        nlohmann::json json = nlohmann::json::parse(contents, nullptr, false);
        EXPECT_TRUE(json.is_object()) << entry.path();
        forget_times(json);
        contents = json.dump();
      }
      out.emplace_back(entry.path().lexically_relative(scratch_.at("out")).string(), contents);
    }
    std::sort(out.begin(), out.end());
    return out;
  }
  static bool is_manifest(const std::string& name) {
    return name.find(".shard-") != std::string::npos && name.ends_with(".json") && !name.ends_with(".answers.json");
  }
  // Expects that a manifest of a run that has failed lists only files that are there.
  void expect_true_manifest(const std::string& contents, const std::string& what) const {
    const nlohmann::json manifest = nlohmann::json::parse(contents);
    for (const nlohmann::json& item : manifest["items"]) {
      for (const nlohmann::json& file : item["files"]) {
        std::error_code missing;
        const auto bytes = fs::file_size(scratch_.at("out/" + file["file"].get<std::string>()), missing);
        EXPECT_FALSE(missing) << what << ": " << file;
        EXPECT_EQ(bytes, file["bytes"].get<std::uintmax_t>()) << what << ": " << file;
      }
    }
  }
  void clear() const {
    fs::remove_all(scratch_.at("out"));
    fs::create_directory(scratch_.at("out"));
  }

  struct Fault {
    std::string call;
    long at;
    int error;
  };
  // Runs the verb with a fault. `good` is the output of a run without one; a part of it may be missing.
  void try_fault(const std::vector<std::string>& arguments, const Fault& fault, const Files& good) {
    clear();
    set_fault(fault.at, fault.error, fault.call);
    const ProcessResult process = run(arguments);
    set_fault(0, 0, "");
    const std::string what = arguments[0] + ", " + fault.call + " " + std::to_string(fault.at) + ": " +
                             std::strerror(fault.error) + ": " + process.err;
    const auto made = output();
    if (process.status == 0) {
      EXPECT_EQ(made, good) << what;
      return;
    }
    EXPECT_EQ(process.status, 1) << what;
    EXPECT_EQ(process.out, "") << what;
    // The error is the last line. Notes may precede it.
    const std::size_t error = process.err.find("tyndall: error: ");
    ASSERT_NE(error, std::string::npos) << what;
    EXPECT_EQ(process.err.find('\n', error), process.err.size() - 1) << what;
    EXPECT_NE(process.err.find(scratch_.at("out"), error), std::string::npos) << what;
    EXPECT_NE(process.err.find("cannot ", error), std::string::npos) << what;
    EXPECT_NE(made, good) << what;
    for (const auto& file : made) {
      if (is_manifest(file.first)) {
        expect_true_manifest(file.second, what);
      } else {
        EXPECT_NE(std::find(good.begin(), good.end(), file), good.end()) << what << ": " << file.first << " is left";
      }
    }
  }
  // Tries the named faults of a verb, or all of them.
  void expect_safe(const std::string& name, const std::vector<std::string>& arguments, const std::vector<Fault>& some) {
    clear();
    set_fault(0, 0, "");
    const std::string log = scratch_.at("calls");
    fs::remove(log);
    set("TYNDALL_FAULT_LOG", log);
    const ProcessResult process = run(arguments);
    ::unsetenv("TYNDALL_FAULT_LOG");
    ASSERT_EQ(process.status, 0) << process.err;
    const auto good = output();
    ASSERT_FALSE(good.empty());
    const std::string names = contents_of(log);
    const long calls = std::count(names.begin(), names.end(), '\n');
    EXPECT_GT(calls, 3);
    std::vector<Fault> faults = some;
    if (const long wanted = many_faults(); wanted > 0) {
      // Try every call with every reason, or as many of these pairs as TYNDALL_WRITE_FAULTS says.
      faults.clear();
      const std::vector<int> errors = {ENOSPC, EACCES, EIO, EINTR, EROFS, kShortWrite};
      const auto reasons = static_cast<long>(errors.size());
      const long all = calls * reasons, count = std::min(wanted, all);
      for (long i = 0; i < count; ++i) {
        const long reason = count == all ? i % reasons : i;
        faults.push_back({"", 1 + i * all / count / reasons, errors[static_cast<std::size_t>(reason % reasons)]});
      }
    }
    for (const Fault& fault : faults) try_fault(arguments, fault, good);
    // The next run must make all files, and leave no others.
    const ProcessResult again = run(arguments);
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(output(), good);
    std::cout << name << ": " << calls << " calls that write, " << faults.size() << " faults\n";
  }
  static long many_faults() {
    const char* const count = std::getenv("TYNDALL_WRITE_FAULTS");
    return count != nullptr ? std::atol(count) : 0;
  }
  [[nodiscard]] std::vector<std::string> with_small_tables(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
    return arguments;
  }

  // Returns the arguments of a `render` that is quick, because nothing is in the scene.
  [[nodiscard]] std::vector<std::string> small_frame(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"render", "--size", "16x9", "--set", "terrain.source=none"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return with_small_tables(std::move(arguments));
  }

  Scratch scratch_;
};

// Only some of the verbs are quick enough for every run of the tests.
#define TYNDALL_SKIP_UNLESS_MANY() \
  if (many_faults() == 0) GTEST_SKIP() << "takes long; runs with TYNDALL_WRITE_FAULTS=200"

TEST_F(CliWriteFaults, Probe) {
  const std::string queries = scratch_.write("q.csv", kQueries);
  std::vector<Fault> faults;
  for (long at = 1; at <= 5; ++at)
    for (const int error : {ENOSPC, EACCES}) faults.push_back({"", at, error});
  expect_safe("probe", {"probe", "--queries", queries, "--model", "homogeneous", "-o", scratch_.at("out/r.csv")},
              faults);
}

TEST_F(CliWriteFaults, ProbeShard) {
  const std::string queries = scratch_.write("q.csv", kQueries);
  expect_safe(
      "probe --shard",
      {"probe", "--queries", queries, "--model", "homogeneous", "-o", scratch_.at("out/r.csv"), "--shard", "1/2"},
      {{"linkat", 2, ENOSPC}, {"", 3, EIO}, {"", 12, EROFS}});
}

TEST_F(CliWriteFaults, Merge) {
  const std::string queries = scratch_.write("q.csv", kQueries);
  std::vector<std::string> merge = {"merge", scratch_.at("out/r.csv")};
  for (const char* const shard : {"1/2", "2/2"}) {
    const ProcessResult made = run_tyndall(
        {"probe", "--queries", queries, "--model", "homogeneous", "-o", scratch_.at("r.csv"), "--shard", shard});
    ASSERT_EQ(made.status, 0) << made.err;
    merge.push_back(scratch_.at("r.csv.shard-" + std::string(1, shard[0]) + "-of-2.json"));
  }
  expect_safe("merge", merge, {{"", 1, EROFS}, {"", 3, ENOSPC}, {"linkat", 1, EIO}});
}

TEST_F(CliWriteFaults, Compare) {
  for (const char* const yaw : {"0", "5"}) {
    const ProcessResult made =
        run_tyndall(with_small_tables({"render", "--size", "16x9", "--set", std::string("camera.yaw_deg=") + yaw, "-o",
                                       scratch_.at(std::string(yaw) + ".png")}));
    ASSERT_EQ(made.status, 0) << made.err;
  }
  for (const char* const ending : {"png", "exr"}) {
    if (many_faults() == 0 && std::string(ending) == "exr") continue;
    const std::vector<std::string> pictures = {scratch_.at("0.png"), scratch_.at("5.png")};
    expect_safe(std::string("compare --diff ") + ending,
                {"compare", pictures[0], pictures[1], "--diff", scratch_.at(std::string("out/d.") + ending)},
                {{"", 1, EACCES}, {"write", 2, ENOSPC}, {"linkat", 1, EIO}});
  }
}

TEST_F(CliWriteFaults, Render) {
  expect_safe("render --frames", small_frame({"--frames", "2", "-o", scratch_.at("out/f%d.png")}),
              {{"rename", 2, EACCES}});
}

TEST_F(CliWriteFaults, RenderOne) {
  TYNDALL_SKIP_UNLESS_MANY();
  expect_safe("render", small_frame({"-o", scratch_.at("out/f.exr")}), {});
}

TEST_F(CliWriteFaults, RenderShard) {
  TYNDALL_SKIP_UNLESS_MANY();
  expect_safe("render --frames --shard --resume",
              small_frame({"--frames", "4", "--shard", "1/2", "--resume", "-o", scratch_.at("out/f%d.png")}), {});
}

TEST_F(CliWriteFaults, Sky) {
  TYNDALL_SKIP_UNLESS_MANY();
  expect_safe("sky",
              with_small_tables({"sky", "-o", scratch_.at("out/sky.exr"), "--size", "8x4", "--sun-elevation-deg", "20",
                                 "--sun-azimuth-deg", "0"}),
              {});
}

TEST_F(CliWriteFaults, SkyList) {
  TYNDALL_SKIP_UNLESS_MANY();
  const std::string list = scratch_.write("skies.csv", "sun_elevation_deg,sun_azimuth_deg\n20,0\n30,10\n");
  expect_safe("sky --list",
              with_small_tables({"sky", "--list", list, "-o", scratch_.at("out/sky_%d.exr"), "--size", "8x4", "--sun",
                                 "split", "--resume"}),
              {});
}

// cli.tables tests a full disk in every run.
TEST_F(CliWriteFaults, Tables) {
  TYNDALL_SKIP_UNLESS_MANY();
  expect_safe("tables", with_small_tables({"tables", "-o", scratch_.at("out/tables")}), {});
}

// `validate` computes many rays. It writes its files with the same functions as `probe`.
TEST_F(CliWriteFaults, Validate) {
  TYNDALL_SKIP_UNLESS_MANY();
  expect_safe("validate",
              with_small_tables({"validate", "--rays", "18", "--samples", "2", "--orders", "1", "-o",
                                 scratch_.at("out/v.html"), "--markdown", scratch_.at("out/v.md")}),
              {});
}

TEST_F(CliWriteFaults, ValidateShard) {
  TYNDALL_SKIP_UNLESS_MANY();
  expect_safe("validate --shard",
              with_small_tables({"validate", "--rays", "18", "--samples", "2", "--orders", "1", "-o",
                                 scratch_.at("out/v.html"), "--shard", "2/9"}),
              {});
}

}  // namespace
}  // namespace tyndall::cli
