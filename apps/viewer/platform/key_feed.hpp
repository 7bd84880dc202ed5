// Keys and clicks for the GUI, a frame's worth at a time. A frame on a slow device takes as long as some people need
// for several keys, and ImGui sees of a key only whether it is down when a frame begins: what is pressed and let go in
// between would be lost, and text after a Tab would land in the field before it. What must not be seen in one frame
// waits for the next.
#pragma once

#include <deque>
#include <vector>

namespace tyndall::viewer {

struct KeyEvent {
  enum class Kind { key, character, button };
  Kind kind = Kind::key;
  int key = 0, scancode = 0, action = 0, mods = 0;  // as GLFW has them; of a button its number in `key`
  unsigned character = 0;                           // UTF-32
  double x = 0.0, y = 0.0;                          // of the pointer [px], for a button
};

class KeyFeed {
 public:
  void add(const KeyEvent& event) { waiting_.push_back(event); }
  // Those for the next frame, in their order.
  [[nodiscard]] std::vector<KeyEvent> take();
  [[nodiscard]] bool empty() const { return waiting_.empty(); }

 private:
  std::deque<KeyEvent> waiting_;
};

}  // namespace tyndall::viewer
