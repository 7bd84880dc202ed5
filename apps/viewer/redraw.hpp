// Decides when the viewer draws its GUI again and how long its loop may sleep. Uses neither the window nor the scenes.
// Times are seconds on the viewer's clock.
#pragma once

namespace tyndall::viewer {

// The state on which the schedule depends.
struct LoopState {
  double now = 0.0;
  bool slow_device = false;  // scenes are drawn without a GPU
  bool busy = false;         // a scene is being drawn or created
  bool work_due = false;     // a scene could begin its next piece of work
  bool moving = false;       // the camera or the sun moves
  bool adapting = false;     // auto exposure has not settled
  bool background = false;   // another thread is working on files, tables or shaders
  bool idle_work = false;    // a scene has work that waits for the user to rest
  bool showing_toasts = false;
  double store_tables_in_s = -1.0;  // time until tables should be stored; negative: never
};

class Redraw {
 public:
  // Requests that at least this many more frames of the GUI are drawn.
  void request(int frames);
  // Notes that the user did something: the GUI is drawn until it has settled.
  void note_input(double now);
  // Notes user input that changes the picture only, such as a held key.
  void note_motion(double now);
  // Notes that a frame of the GUI has been presented.
  void note_drawn(double now);

  [[nodiscard]] bool due() const { return frames_ > 0; }
  // Returns whether the GUI has settled and the user has done nothing for a while.
  [[nodiscard]] bool resting(double now) const;
  // Returns whether the next frame of the GUI has to wait, so that a device without a GPU gets on with the scene.
  [[nodiscard]] bool throttled(const LoopState& state) const;
  // Returns how long to wait for input [s]: 0 while there is something to draw or to begin, negative for ever.
  [[nodiscard]] double wait_time(const LoopState& state) const;

 private:
  int frames_ = 3;  // number of frames of the GUI that are still to be drawn
  double last_input_ = 0.0;
  double last_drawn_ = -1.0;
};

}  // namespace tyndall::viewer
