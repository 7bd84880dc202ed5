#include "viewer/present_log.hpp"

namespace tyndall::viewer {

void PresentLog::add(const Frame& frame, Notices& notices) {
  if (frame.present_mode != last_.present_mode) notices.log("present_mode " + frame.present_mode);
  if (!opened_) {
    // The first frame of the window counts as part of the start-up, because the driver compiles the GUI's shaders in
    // it.
    opened_ = true;
    notices.log("opened");
  }
  const bool has_picture = frame.scene_frames > 0;
  const bool is_new = frame.scene_frames != last_.scene_frames || frame.window.width != last_.window.width;
  if (has_picture && is_new) {
    notices.log("shown " + std::to_string(frame.scene_frames) + " in " + std::to_string(frame.window.width) + " " +
                std::to_string(frame.window.height));
  }
  if (frame.two != last_.two) notices.log(frame.two ? "shown two" : "shown one");
  if (has_picture && !ready_) {
    ready_ = true;
    notices.log("ready " + std::to_string(notices.now()));
  }
  last_ = frame;
}

}  // namespace tyndall::viewer
