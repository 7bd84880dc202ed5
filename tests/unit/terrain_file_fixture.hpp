// Reads elevation files that a test has written, and checks that nothing is printed.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "scene/elevation/elevation_file.hpp"
#include "terrain_files.hpp"

namespace tyndall::scene {

constexpr double kRadius_m = 6360000.0;

inline double hill(int x, int y) { return 1000.0 + 8.0 * x + 3.0 * y; }

class ElevationFile : public ::testing::Test {
 protected:
  ElevationRaster read(const std::filesystem::path& path, int max_samples = kMaxElevationSamples) {
    testing::internal::CaptureStderr();
    Result<ElevationRaster> result = read_elevation_file(path.string(), {kRadius_m, max_samples});
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? std::move(result).value() : ElevationRaster{};
  }
  std::string error(const std::filesystem::path& path) {
    testing::internal::CaptureStderr();
    Result<ElevationRaster> result = read_elevation_file(path.string(), {kRadius_m});
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_FALSE(result.ok()) << path;
    if (result.ok()) return {};
    std::string message = result.error().message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find(path.filename().string()), std::string::npos) << message;
    return message;
  }
  static float at(const ElevationRaster& r, int x, int y) {
    return r.heights[static_cast<std::size_t>(y) * r.width + x];
  }
  static bool noted(const ElevationRaster& r, const std::string& text) {
    return std::any_of(r.notes.begin(), r.notes.end(),
                       [&](const std::string& note) { return note.find(text) != std::string::npos; });
  }

  TestFolder folder_;
};

}  // namespace tyndall::scene
