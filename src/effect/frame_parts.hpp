// The state of a frame that is recorded in two parts. It holds the inputs of the first part until the second follows,
// and refuses calls that are not allowed between them.
#pragma once

#include <array>
#include <cstdint>

#include "tyndall/effect.hpp"

namespace tyndall {

class FrameParts {
 public:
  // Returns an error if this part cannot be recorded now, or has other inputs than the first part of its frame.
  [[nodiscard]] Result<void> check(const FrameInputs& inputs, FramePart part) const;
  // Returns an error between the parts of a frame, for functions that change what the second one reads.
  [[nodiscard]] Result<void> check_between(const char* where) const;
  // Notes that a part has been recorded. Allocates nothing.
  void recorded(const FrameInputs& inputs, FramePart part);
  // Returns whether the second part of a frame is missing.
  [[nodiscard]] bool open() const { return open_; }

 private:
  bool open_ = false;
  FrameInputs inputs_;  // of the first part, without the cascades
  std::array<Cascade, kMaxCascades> cascades_ = {};
  std::size_t cascade_count_ = 0;
};

}  // namespace tyndall
