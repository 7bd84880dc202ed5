// The viewer at rest: it stores tables, and then sleeps.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;
namespace fs = std::filesystem;

std::size_t files_in(const std::string& folder) {
  std::size_t count = 0;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    count += entry.is_regular_file() ? 1 : 0;
  return count;
}

double time_of(const std::string& line) { return std::strtod(line.c_str(), nullptr); }

TEST(Window, SleepsWhenNothingChanges) {
  NEEDS_A_DESK();
  Desk desk("rest");
  ASSERT_TRUE(desk.open(joined(kSmall, kSmallTables))) << desk.errors();
  // After all pipelines have been created, the exposure has adapted and the tables are stored, the loop stops.
  ASSERT_TRUE(desk.wait_for({"pipelines"}));
  ASSERT_TRUE(desk.wait_for({"resting"}));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const std::size_t lines = desk.lines();
  const double before_s = desk.cpu_s();
  std::this_thread::sleep_for(std::chrono::seconds(5));
  EXPECT_GT(before_s, 0.0);
  EXPECT_LT(desk.cpu_s() - before_s, 0.1) << "of 5 s";
  EXPECT_EQ(desk.lines(), lines);
  desk.picture("resting");
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

// The first tables are stored immediately. Those of later parameters are stored only once the parameters have been
// stable for 20 s, so intermediate values of a slider are not stored.
TEST(Window, CachesTablesOnceParametersAreStable) {
  NEEDS_A_DESK();
  Desk desk("cached");
  const std::string cache = desk.folder() + "/cache";
  ASSERT_TRUE(desk.open(
      joined(joined({"--size", "640x360", "--no-first-steps"}, kSmallTables), {"--set", "tables.cache=" + cache})))
      << desk.errors();
  ASSERT_TRUE(desk.wait_for({"tables stored"}));
  const std::size_t first = files_in(cache);
  EXPECT_GE(first, 1U);

  std::size_t from = desk.lines();
  ASSERT_TRUE(pull(desk, "atmosphere.aerosol_density", {0.3}));
  ASSERT_TRUE(desk.wait_for({"set atmosphere.aerosol_density"}, from));
  ASSERT_TRUE(desk.wait_for({" tables"}, from));
  std::this_thread::sleep_for(std::chrono::seconds(2));
  from = desk.lines();
  ASSERT_TRUE(pull(desk, "atmosphere.aerosol_density", {0.4}));
  ASSERT_TRUE(desk.wait_for({"set atmosphere.aerosol_density"}, from));
  const std::optional<std::string> stored = desk.wait_for({"tables stored"}, from);
  ASSERT_TRUE(stored);
  // The last time at which tables were finished.
  double finished_s = 0.0;
  while (const std::optional<std::string> line = desk.wait_for({" tables"}, from, 1.0)) {
    if (line->ends_with(" tables")) finished_s = time_of(*line);
    from += 1;
    if (from >= desk.lines()) break;
  }
  EXPECT_GT(finished_s, 0.0);
  // The 20 s start when the tables are finished. The line in the log follows with the frame that uses them.
  constexpr double kFrame_s = 1.0;
  EXPECT_GE(time_of(*stored) - finished_s, 20.0 - kFrame_s);
  EXPECT_LE(time_of(*stored) - finished_s, 30.0);
  ASSERT_TRUE(desk.wait_for({"resting"}, from > 0 ? from - 1 : 0));
  EXPECT_EQ(files_in(cache), first + 1) << "those in between are not stored";
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

}  // namespace
}  // namespace tyndall
