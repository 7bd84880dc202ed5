#include "viewer/platform/key_feed.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace tyndall::viewer {
namespace {

bool modifies(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

// Returns whether the key only writes a character; together with Ctrl it may do something else.
bool writes(const KeyEvent& event) { return event.key < GLFW_KEY_ESCAPE && (event.mods & GLFW_MOD_CONTROL) == 0; }

}  // namespace

std::vector<KeyEvent> KeyFeed::take() {
  using Kind = KeyEvent::Kind;
  std::vector<KeyEvent> out;
  bool edited = false;  // a key or click of this frame may move the focus, which decides where later text goes
  for (; !waiting_.empty(); waiting_.pop_front()) {
    const KeyEvent& event = waiting_.front();
    if (event.kind == Kind::character && edited) break;
    if (event.kind == Kind::button || (event.kind == Kind::key && !writes(event))) {
      const auto same = [&event](const KeyEvent& e) { return e.kind == event.kind && e.key == event.key; };
      if (std::any_of(out.begin(), out.end(), same)) break;
      const bool edits = event.action == GLFW_PRESS && (event.kind == Kind::button || !modifies(event.key));
      if (edits && edited) break;
      edited = edited || edits;
    }
    out.push_back(event);
  }
  return out;
}

}  // namespace tyndall::viewer
