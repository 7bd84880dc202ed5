// Times of the last frames, for graphs.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "scene/scene.hpp"

namespace tyndall::viewer {

struct FrameTimes {
  static constexpr std::size_t kCount = 128;
  std::array<float, kCount> gpu = {};    // [ms] all passes
  std::array<float, kCount> whole = {};  // [ms] from one frame of the scene to the next
  std::size_t next = 0;                  // index of the oldest entry, which is overwritten next
  std::vector<scene::PassTime> passes;   // of the last frame, smoothed
  void add(const std::vector<scene::PassTime>& times, double whole_ms);
};

}  // namespace tyndall::viewer
