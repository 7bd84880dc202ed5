// The duration of the steps of the GUI's loop, which is the longest time that user input has to wait.
#pragma once

#include <cstdint>
#include <string>

namespace tyndall::viewer {

class StepTimes {
 public:
  // Adds a step and returns whether it is the longest so far.
  bool add(double milliseconds);
  // Returns "N longest_ms X over_100_ms A over_200_ms B".
  [[nodiscard]] std::string text() const;
  // Forgets all steps.
  void reset() { *this = {}; }

 private:
  std::uint64_t count_ = 0, over_100_ = 0, over_200_ = 0;
  double longest_ms_ = 0.0;
};

}  // namespace tyndall::viewer
