// Recording a frame in two parts: remembers the first one until the second follows, and refuses what would come
// between.
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
