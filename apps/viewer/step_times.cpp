#include "viewer/step_times.hpp"

#include <algorithm>

namespace tyndall::viewer {

bool StepTimes::add(double milliseconds) {
  ++count_;
  if (milliseconds > 100.0) ++over_100_;
  if (milliseconds > 200.0) ++over_200_;
  const bool longest = milliseconds > longest_ms_;
  longest_ms_ = std::max(longest_ms_, milliseconds);
  return longest;
}

std::string StepTimes::text() const {
  return std::to_string(count_) + " longest_ms " + std::to_string(longest_ms_) + " over_100_ms " +
         std::to_string(over_100_) + " over_200_ms " + std::to_string(over_200_);
}

}  // namespace tyndall::viewer
