// Many changes in succession: a script sets every parameter to both ends of its range, and a soak test watches memory.
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

// Returns the median of part `which` (from 0) of `parts` equal parts.
double median_of(const std::vector<double>& all, std::size_t parts, std::size_t which) {
  const std::size_t n = all.size() / parts;
  std::vector<double> part(all.begin() + static_cast<std::ptrdiff_t>(which * n),
                           all.begin() + static_cast<std::ptrdiff_t>((which + 1) * n));
  std::nth_element(part.begin(), part.begin() + static_cast<std::ptrdiff_t>(n / 2), part.end());
  return part[n / 2];
}

TEST(Window, SetsEveryParameterToBothEnds) {
  NEEDS_A_DESK();
  Desk desk("walk");
  ASSERT_TRUE(desk.open(joined(kSmallTables, {"--size", "128x96", "--no-first-steps", "--script", "walk"})))
      << desk.errors();
  ASSERT_TRUE(desk.wait_for({"script done"}, 0, 900.0));
  EXPECT_EQ(desk.wait_for_end(120.0), 0) << desk.errors();
  // Every number, choice and switch was set to both ends.
  const std::string log = log_text(desk);
  for (const config::Row& row : config::rows()) {
    if (row.info.type == ParamType::string) continue;
    EXPECT_NE(log.find("script " + row.key() + " minimum"), std::string::npos) << row.key();
    EXPECT_NE(log.find("script " + row.key() + " maximum"), std::string::npos) << row.key();
  }
}

TEST(Window, MemoryStaysBoundedThroughRandomChanges) {
  NEEDS_A_DESK();
  // The test takes two minutes, or a given number of frames.
  const char* frames = std::getenv("TYNDALL_SOAK_FRAMES");
  const std::string length = frames != nullptr ? std::string("soak-frames=") + frames : "soak=120";
  Desk desk("soak");
  ASSERT_TRUE(desk.open({"--size", "160x90", "--no-first-steps", "--set", "tables.size=8,16,16,4", "--set",
                         "tables.orders=2", "--script", length}))
      << desk.errors();
  ASSERT_TRUE(desk.wait_for({"script done"}, 0, frames != nullptr ? 86400.0 : 420.0));
  EXPECT_EQ(desk.wait_for_end(120.0), 0) << desk.errors();
  // Lines "memory RESIDENT_KIB DEVICE_BYTES ALLOCATED_KIB". All shaders have been compiled after the first quarter.
  // From then on, memory depends only on the current settings: half of them need 53 MiB more device memory than the
  // others, which on a CPU device is memory of the process.
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
  // Compare the second and the last quarter, which are a minute apart. For memory allocated by malloc (without device
  // memory), the medians are compared; they differ by up to 22 MiB. Resident memory varies by 60 MiB with
  // fragmentation, so its median is too noisy. Instead, the minimum of the last quarter must be at most 6 MiB above the
  // maximum of the second. For comparison, an error that compiled shaders again for every value of a slider took 3
  // MiB/s, or 90 MiB from the end of the second quarter to the start of the last. The smallest settings recur, and each
  // time device memory returns to 23 to 28 MiB.
  const double allocated_growth = median_of(allocated, 4, 3) - median_of(allocated, 4, 1);
  const auto quarter = [](const std::vector<double>& all, std::size_t which) {
    return all.begin() + static_cast<std::ptrdiff_t>(all.size() * which / 4);
  };
  const auto minimum = [&](const std::vector<double>& all, std::size_t from, std::size_t to) {
    return *std::min_element(quarter(all, from), quarter(all, to));
  };
  const double resident_rise = minimum(resident, 3, 4) - *std::max_element(quarter(resident, 1), quarter(resident, 2));
  EXPECT_LT(allocated_growth, 40.0) << "MiB";
  EXPECT_LT(resident_rise, 20.0) << "MiB";
  EXPECT_LT(minimum(device, 2, 4) - minimum(device, 1, 2), 10.0) << "MiB";
  for (std::size_t part = 0; part < 8; ++part) {
    std::printf("eighth %zu: resident %.1f MiB, allocated beside device memory %.1f MiB\n", part + 1,
                median_of(resident, 8, part), median_of(allocated, 8, part));
  }
  RecordProperty("resident_rise_mib", static_cast<int>(resident_rise));
  RecordProperty("allocated_growth_mib", static_cast<int>(allocated_growth));
}

}  // namespace
}  // namespace tyndall
