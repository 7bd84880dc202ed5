// Screenshots: the picture as PNG and the radiance as EXR, written by a thread beside the GUI's.
#pragma once

#include <future>
#include <optional>
#include <string>

#include "viewer/scenes/scene_work.hpp"

namespace tyndall::viewer {

class Screenshot {
 public:
  Screenshot() = default;
  Screenshot(const Screenshot&) = delete;
  Screenshot& operator=(const Screenshot&) = delete;
  ~Screenshot();

  // Requests that the next frame is captured.
  void request() { requested_ = true; }
  // Returns whether a capture is to be made now: one is requested and none is being written.
  [[nodiscard]] bool wants_capture() const { return requested_ && !writing(); }
  // Begins to write a capture into a folder (empty: the working directory), and removes what killed runs have left
  // there.
  void write(Capture capture, const std::string& folder);
  [[nodiscard]] bool writing() const { return writing_.valid(); }
  // Returns the name of the files without their endings once they are written, or why they are not; otherwise nothing.
  [[nodiscard]] std::optional<Result<std::string>> take_written();

 private:
  bool requested_ = false;
  std::future<Result<std::string>> writing_;
};

}  // namespace tyndall::viewer
