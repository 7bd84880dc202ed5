// Many changes, one after the other: every parameter to both ends by a script, and a soak that keeps its memory.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "config/settings.hpp"
#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;

// Of one of `parts` equal parts, counted from 0.
double median_of(const std::vector<double>& all, std::size_t parts, std::size_t which) {
  const std::size_t n = all.size() / parts;
  std::vector<double> part(all.begin() + static_cast<std::ptrdiff_t>(which * n), all.begin() + static_cast<std::ptrdiff_t>((which + 1) * n));
  std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(n / 2), part.end());
  return part[n / 2];
}

TEST(Window, TakesEveryParameterToBothEnds) {
  NEEDS_A_DESK();
  Desk desk("walk");
  ASSERT_TRUE(desk.open(joined(kSmallTables, {"--size", "128x96", "--no-first-steps", "--script", "walk"}))) << desk.errors();
  ASSERT_TRUE(desk.wait_for({"script done"}, 0, 900.0));
  EXPECT_EQ(desk.wait_for_end(120.0), 0) << desk.errors();
  // Every number, choice and switch was there, at both ends.
  const std::string log = desk.log_text();
  for (const config::Row& row : config::rows()) {
    if (row.info.type == ParamType::string) continue;
    EXPECT_NE(log.find("script " + row.key() + " least"), std::string::npos) << row.key();
    EXPECT_NE(log.find("script " + row.key() + " largest"), std::string::npos) << row.key();
  }
}

TEST(Window, KeepsItsMemoryThroughRandomChanges) {
  NEEDS_A_DESK();
  // Two minutes, or so many frames.
  const char* frames = std::getenv("TYNDALL_SOAK_FRAMES");
  const std::string length = frames != nullptr ? std::string("soak-frames=") + frames : "soak=120";
  Desk desk("soak");
  ASSERT_TRUE(desk.open({"--size", "160x90", "--no-first-steps", "--set", "tables.size=8,16,16,4", "--set", "tables.orders=2",
                         "--script", length}))
      << desk.errors();
  ASSERT_TRUE(desk.wait_for({"script done"}, 0, frames != nullptr ? 86400.0 : 420.0));
  EXPECT_EQ(desk.wait_for_end(120.0), 0) << desk.errors();
  // Lines "memory RESIDENT_KIB DEVICE_BYTES ALLOCATED_KIB". Every shader has been compiled in the first quarter; from there on
  // memory stands still, but for what the settings of the moment take: medians of the second and the last quarter.
  std::vector<double> resident, allocated;
  std::istringstream text(desk.log_text());
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string time, word;
    double resident_kib = 0.0, device_bytes = 0.0, allocated_kib = 0.0;
    if (!(words >> time >> word) || word != "memory" || !(words >> resident_kib >> device_bytes >> allocated_kib)) continue;
    resident.push_back(resident_kib / 1024.0);
    allocated.push_back(allocated_kib / 1024.0);
  }
  ASSERT_GT(resident.size(), 16U);
  const auto growth_mib = [](const std::vector<double>& all) { return median_of(all, 4, 3) - median_of(all, 4, 1); };
  // A minute lies between them. Measured over 1500 changes: both stand still from the 400th on, and differ by up to 20 MiB from one
  // quarter of two minutes to another; before, the heap grows to its size. Shaders that were compiled anew for every value of a
  // slider took 3 MiB/s.
  EXPECT_LT(growth_mib(resident), 40.0) << "MiB";
  EXPECT_LT(growth_mib(allocated), 40.0) << "MiB";
  for (std::size_t part = 0; part < 8; ++part) {
    std::printf("eighth %zu: resident %.1f MiB, allocated %.1f MiB\n", part + 1, median_of(resident, 8, part), median_of(allocated, 8, part));
  }
  RecordProperty("resident_growth_mib", static_cast<int>(growth_mib(resident)));
  RecordProperty("allocated_growth_mib", static_cast<int>(growth_mib(allocated)));
}

}  // namespace
}  // namespace tyndall
