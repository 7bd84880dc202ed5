// A queue of keys and clicks, which passes them to the GUI in portions that fit one frame. A frame on a slow device may
// last as long as several key presses, and ImGui sees only whether a key is down when a frame begins: a key that is
// pressed and released within a frame would be lost, and text after a Tab would go to the previous field. Events that
// must not share a frame wait for the next one.
#pragma once

#include <deque>
#include <vector>

namespace tyndall::viewer {

struct KeyEvent {
  enum class Kind { key, character, button };
  Kind kind = Kind::key;
  int key = 0, scancode = 0, action = 0, mods = 0;  // as in GLFW; for a button, `key` is its number
  unsigned character = 0;                           // UTF-32
  double x = 0.0, y = 0.0;                          // position of the pointer [px], for a button
};

class KeyFeed {
 public:
  void add(const KeyEvent& event) { waiting_.push_back(event); }
  // Removes and returns the events for the next frame, in order.
  [[nodiscard]] std::vector<KeyEvent> take();
  [[nodiscard]] bool empty() const { return waiting_.empty(); }

 private:
  std::deque<KeyEvent> waiting_;
};

}  // namespace tyndall::viewer
