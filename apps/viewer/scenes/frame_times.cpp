#include "viewer/scenes/frame_times.hpp"

#include <algorithm>

namespace tyndall::viewer {

void FrameTimes::add(const std::vector<scene::PassTime>& times, double whole_ms) {
  double sum = 0.0;
  for (const scene::PassTime& time : times) {
    if (time.name != "effect") sum += time.ms;  // on GPUs, the time of the whole effect
  }
  gpu[next] = static_cast<float>(sum);
  whole[next] = static_cast<float>(whole_ms);
  next = (next + 1) % kCount;
  const bool same = passes.size() == times.size() &&
                    std::equal(passes.begin(), passes.end(), times.begin(),
                               [](const scene::PassTime& a, const scene::PassTime& b) { return a.name == b.name; });
  if (!same) {
    passes = times;
    return;
  }
  for (std::size_t i = 0; i < passes.size(); ++i) passes[i].ms += 0.2 * (times[i].ms - passes[i].ms);
}

}  // namespace tyndall::viewer
