// How long the steps of the GUI's loop take: what a hand waits for at most, apart from what the system takes.
#pragma once

#include <cstdint>
#include <string>

namespace tyndall::viewer {

class StepTimes {
 public:
  // Whether it is the longest so far.
  bool add(double milliseconds);
  // "N longest_ms X over_100_ms A over_200_ms B".
  [[nodiscard]] std::string text() const;
  // From here on.
  void reset() { *this = {}; }

 private:
  std::uint64_t count_ = 0, over_100_ = 0, over_200_ = 0;
  double longest_ms_ = 0.0;
};

}  // namespace tyndall::viewer
