// Logs changes of what the window shows, for tests and for measurements of the start-up time.
#pragma once

#include <cstdint>
#include <string>

#include "viewer/notices.hpp"

namespace tyndall::viewer {

class PresentLog {
 public:
  // The contents of a presented frame of the GUI.
  struct Frame {
    std::uint64_t scene_frames = 0;  // drawn so far; 0: no picture yet
    VkExtent2D window = {};
    bool two = false;  // both sides of a comparison
    std::string present_mode;
  };
  // Logs the differences from the last frame.
  void add(const Frame& frame, Notices& notices);

 private:
  Frame last_;
  bool opened_ = false;
  bool ready_ = false;
};

}  // namespace tyndall::viewer
