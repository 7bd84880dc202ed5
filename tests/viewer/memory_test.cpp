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
  std::vector<double> part(all.begin() + static_cast<std::ptrdiff_t>(which * n),
                           all.begin() + static_cast<std::ptrdiff_t>((which + 1) * n));
  std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(n / 2), part.end());
  return part[n / 2];
}

TEST(Window, TakesEveryParameterToBothEnds) {
  NEEDS_A_DESK();
  Desk desk("walk");
  ASSERT_TRUE(desk.open(joined(kSmallTables, {"--size", "128x96", "--no-first-steps", "--script", "walk"})))
      << desk.errors();
  ASSERT_TRUE(desk.wait_for({"script done"}, 0, 900.0));
  EXPECT_EQ(desk.wait_for_end(120.0), 0) << desk.errors();
  // Every number, choice and switch was there, at both ends.
  const std::string log = log_text(desk);
  for (const config::Row& row : config::rows()) {
    if (row.info.type == ParamType::string) continue;
    EXPECT_NE(log.find("script " + row.key() + " least"), std::string::npos) << row.key();
    EXPECT_NE(log.find("script " + row.key() + " largest"), std::string::npos) << row.key();
  }
}

TEST(Window, MemoryStaysBoundedThroughRandomChanges) {
  NEEDS_A_DESK();
  // Two minutes, or so many frames.
  const char* frames = std::getenv("TYNDALL_SOAK_FRAMES");
  const std::string length = frames != nullptr ? std::string("soak-frames=") + frames : "soak=120";
  Desk desk("soak");
  ASSERT_TRUE(desk.open({"--size", "160x90", "--no-first-steps", "--set", "tables.size=8,16,16,4", "--set",
                         "tables.orders=2", "--script", length}))
      << desk.errors();
  ASSERT_TRUE(desk.wait_for({"script done"}, 0, frames != nullptr ? 86400.0 : 420.0));
  EXPECT_EQ(desk.wait_for_end(120.0), 0) << desk.errors();
  // Lines "memory RESIDENT_KIB DEVICE_BYTES ALLOCATED_KIB". Every shader has been compiled in the first quarter; from
  // there on memory stands still, but for what the settings of the moment take: half of them take 53 MiB more of device
  // memory than the others, which on a device without a GPU is the process's own.
  std::vector<double> resident, allocated, device;
  std::istringstream text(log_text(desk));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string time, word;
    double resident_kib = 0.0, device_bytes = 0.0, allocated_kib = 0.0;
    if (!(words >> time >> word) || word != "memory" || !(words >> resident_kib >> device_bytes >> allocated_kib))
      continue;
    resident.push_back(resident_kib / 1024.0);
    device.push_back(device_bytes / (1024.0 * 1024.0));
    allocated.push_back(allocated_kib / 1024.0 - device.back());
  }
  ASSERT_GT(resident.size(), 16U);
  // Of the second and the last quarter, between which a minute lies. What malloc has handed out beside device memory:
  // by the medians, which differ by up to 22 MiB. Resident memory goes up and down by 60 MiB with what is freed where,
  // and so hardly tells by its medians: the least of the last quarter is at most 6 MiB above the greatest of the
  // second. Shaders that were compiled anew for every value of a slider took 3 MiB/s, which is 90 MiB from the end of
  // the second quarter to the begin of the last. Device memory comes back to what the leanest settings take, which are
  // there again and again: 23 to 28 MiB.
  const double allocated_growth = median_of(allocated, 4, 3) - median_of(allocated, 4, 1);
  const auto quarter = [](const std::vector<double>& all, std::size_t which) {
    return all.begin() + static_cast<std::ptrdiff_t>(all.size() * which / 4);
  };
  const auto least = [&](const std::vector<double>& all, std::size_t from, std::size_t to) {
    return *std::min_element(quarter(all, from), quarter(all, to));
  };
  const double resident_rise = least(resident, 3, 4) - *std::max_element(quarter(resident, 1), quarter(resident, 2));
  EXPECT_LT(allocated_growth, 40.0) << "MiB";
  EXPECT_LT(resident_rise, 20.0) << "MiB";
  EXPECT_LT(least(device, 2, 4) - least(device, 1, 2), 10.0) << "MiB";
  for (std::size_t part = 0; part < 8; ++part) {
    std::printf("eighth %zu: resident %.1f MiB, allocated beside device memory %.1f MiB\n", part + 1,
                median_of(resident, 8, part), median_of(allocated, 8, part));
  }
  RecordProperty("resident_rise_mib", static_cast<int>(resident_rise));
  RecordProperty("allocated_growth_mib", static_cast<int>(allocated_growth));
}

}  // namespace
}  // namespace tyndall
