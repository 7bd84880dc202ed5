// The program when a call that writes its output fails: status 1 and one line with the name of the output, nothing
// half-written under that name, and nothing left after the next run. TYNDALL_WRITE_FAULTS=200 tries that many calls of
// every verb, evenly over the run, which takes long.
#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <iostream>

#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kSmall = {"--set", "tables.size=4,16,12,6", "--set", "tables.orders=1"};

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
  // Returns the names and contents of the output.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> output() const {
    std::vector<std::pair<std::string, std::string>> out;
    for (const auto& entry : fs::recursive_directory_iterator(scratch_.at("out")))
      out.emplace_back(entry.path().lexically_relative(scratch_.at("out")).string(),
                       entry.is_regular_file() ? contents_of(entry.path().string()) : "");
    std::sort(out.begin(), out.end());
    return out;
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
  void try_fault(const std::vector<std::string>& arguments, const Fault& fault,
                 const std::vector<std::pair<std::string, std::string>>& good) {
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
    EXPECT_LT(made.size(), good.size()) << what;
    for (const auto& file : made)
      EXPECT_NE(std::find(good.begin(), good.end(), file), good.end()) << what << ": " << file.first << " is left";
  }
  // Tries the named faults of a verb, or all of them.
  void expect_safe(const std::vector<std::string>& arguments, const std::vector<Fault>& some) {
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
      faults.clear();
      const std::vector<int> errors = {ENOSPC, EACCES, EIO, EINTR};
      for (long i = 0; i < wanted; ++i)
        faults.push_back({"", 1 + i * calls / wanted, errors[static_cast<std::size_t>(i) % errors.size()]});
    }
    for (const Fault& fault : faults) try_fault(arguments, fault, good);
    // The next run makes everything, and leaves nothing else.
    const ProcessResult again = run(arguments);
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(output(), good);
    std::cout << arguments[0] << ": " << calls << " calls that write, " << faults.size() << " faults\n";
  }
  static long many_faults() {
    const char* const count = std::getenv("TYNDALL_WRITE_FAULTS");
    return count != nullptr ? std::atol(count) : 0;
  }
  [[nodiscard]] std::vector<std::string> with_small_tables(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
    return arguments;
  }

  Scratch scratch_;
};

TEST_F(CliWriteFaults, Probe) {
  const std::string queries =
      scratch_.write("q.csv", "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n0,70,50,3\n1000,20,30,4\n");
  std::vector<Fault> faults;
  for (long at = 1; at <= 5; ++at)
    for (const int error : {ENOSPC, EACCES}) faults.push_back({"", at, error});
  expect_safe({"probe", "--queries", queries, "--model", "homogeneous", "-o", scratch_.at("out/r.csv")}, faults);
}

TEST_F(CliWriteFaults, Render) {
  expect_safe(with_small_tables({"render", "--size", "16x9", "--frames", "2", "-o", scratch_.at("out/f%d.png")}),
              {{"rename", 2, EACCES}});
}

TEST_F(CliWriteFaults, Sky) {
  if (many_faults() == 0) GTEST_SKIP() << "takes long; runs with TYNDALL_WRITE_FAULTS=200";
  expect_safe(with_small_tables({"sky", "-o", scratch_.at("out/sky.exr"), "--size", "8x4", "--sun-elevation-deg", "20",
                                 "--sun-azimuth-deg", "0"}),
              {{"write", 2, EIO}});
}

// cli.tables has a full disk.
TEST_F(CliWriteFaults, Tables) {
  if (many_faults() == 0) GTEST_SKIP() << "takes long; runs with TYNDALL_WRITE_FAULTS=200";
  expect_safe(with_small_tables({"tables", "-o", scratch_.at("out/tables")}), {{"write", 7, ENOSPC}});
}

// `validate` draws many rays; its files are written as those of `probe`.
TEST_F(CliWriteFaults, Validate) {
  if (many_faults() == 0) GTEST_SKIP() << "takes long; runs with TYNDALL_WRITE_FAULTS=200";
  expect_safe(with_small_tables({"validate", "--rays", "18", "--samples", "2", "-o", scratch_.at("out/v.html")}), {});
}

}  // namespace
}  // namespace tyndall::cli
