// Functions shared by the tests of the window: they parse frames from the log and drag sliders.
#pragma once

#include <string>
#include <vector>

#include "desk.hpp"

#define NEEDS_A_DESK() \
  if (!tyndall::desk::equipped()) GTEST_SKIP() << "Xvfb or xdotool is not installed"

namespace tyndall::desk {

// The numbers of a line of the log: "frame left N width height ms T camera x y z yaw pitch fov sun az el".
struct Frame {
  int number = 0, width = 0, height = 0;
  double x = 0.0, y = 0.0, z = 0.0, yaw = 0.0, pitch = 0.0, fov = 0.0, azimuth = 0.0, elevation = 0.0;
};

[[nodiscard]] Frame frame_of(const std::string& line);
// Return all frames of the left side so far, and the last one.
[[nodiscard]] std::vector<Frame> frames(const Desk& desk);
[[nodiscard]] Frame last_frame(const Desk& desk);

// Drags a slider from a quarter of its width to each of these fractions of it.
[[nodiscard]] bool pull(Desk& desk, const std::string& key, const std::vector<double>& ways);

// Returns the key of a control that only this panel has.
[[nodiscard]] std::string key_of(const std::string& panel);

// Opens the window of views, switches the comparison on, and waits until two pictures are shown.
[[nodiscard]] bool compare_two(Desk& desk);

inline const std::vector<std::string> kSmall = {"--size", "480x270", "--no-first-steps"};
// Arguments for tables that are built within a second or two.
inline const std::vector<std::string> kSmallTables = {"--set", "tables.size=8,16,16,4", "--set", "tables.orders=2"};

// Returns the arguments of `a` followed by those of `b`.
[[nodiscard]] std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b);

}  // namespace tyndall::desk
