// The key feed distributes key events over frames of the GUI so that none is lost.
#include <gtest/gtest.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <string>
#include <vector>

#include "viewer/platform/key_feed.hpp"

namespace tyndall::viewer {
namespace {

KeyEvent key(int code, int action, int mods = 0) { return {KeyEvent::Kind::key, code, 0, action, mods, 0}; }

void tap(KeyFeed& feed, int code, int mods = 0) {
  feed.add(key(code, GLFW_PRESS, mods));
  if (code < GLFW_KEY_ESCAPE && mods == 0)
    feed.add({KeyEvent::Kind::character, 0, 0, 0, 0, static_cast<unsigned>(code)});
  feed.add(key(code, GLFW_RELEASE, mods));
}

void click(KeyFeed& feed) {
  for (const int action : {GLFW_PRESS, GLFW_RELEASE})
    feed.add({KeyEvent::Kind::button, GLFW_MOUSE_BUTTON_LEFT, 0, action, 0, 0, 4.0, 5.0});
}

// Returns the events of each frame: characters, and names of the keys that are pressed in it.
std::vector<std::string> frames_of(KeyFeed& feed) {
  std::vector<std::string> out;
  while (!feed.empty()) {
    std::string text;
    for (const KeyEvent& event : feed.take()) {
      if (event.kind == KeyEvent::Kind::character) text += static_cast<char>(event.character);
      if (event.kind == KeyEvent::Kind::button) text += event.action == GLFW_PRESS ? "<press>" : "</press>";
      if (event.kind != KeyEvent::Kind::key) continue;
      const bool down = event.action == GLFW_PRESS;
      if (event.key == GLFW_KEY_TAB) text += down ? "<tab>" : "</tab>";
      if (event.key == GLFW_KEY_ENTER) text += down ? "<enter>" : "</enter>";
      if (event.key == GLFW_KEY_LEFT_CONTROL) text += down ? "<ctrl>" : "</ctrl>";
      if (event.key == GLFW_KEY_A && event.mods != 0) text += down ? "<all>" : "</all>";
    }
    out.push_back(text);
  }
  return out;
}

TEST(ViewerKeyFeed, ATappedKeyIsDownForOneFrame) {
  KeyFeed feed;
  tap(feed, GLFW_KEY_ENTER);
  EXPECT_EQ(frames_of(feed), (std::vector<std::string>{"<enter>", "</enter>"}));
  tap(feed, GLFW_KEY_TAB);
  tap(feed, GLFW_KEY_TAB);
  EXPECT_EQ(frames_of(feed), (std::vector<std::string>{"<tab>", "</tab>", "<tab>", "</tab>"}));
}

TEST(ViewerKeyFeed, TextComesInOneFrameAndAfterATabInTheNext) {
  KeyFeed feed;
  for (const char c : {'4', '0', '9', '6'}) tap(feed, c);
  tap(feed, GLFW_KEY_TAB);
  tap(feed, '1');
  tap(feed, GLFW_KEY_ENTER);
  EXPECT_EQ(frames_of(feed), (std::vector<std::string>{"4096<tab>", "</tab>1<enter>", "</enter>"}));
}

TEST(ViewerKeyFeed, CtrlAndClickOpensAFieldBeforeWhatIsTypedIntoIt) {
  KeyFeed feed;
  feed.add(key(GLFW_KEY_LEFT_CONTROL, GLFW_PRESS));
  click(feed);
  feed.add(key(GLFW_KEY_LEFT_CONTROL, GLFW_RELEASE));
  tap(feed, '7');
  EXPECT_EQ(frames_of(feed), (std::vector<std::string>{"<ctrl><press>", "</press></ctrl>7"}));
  feed.add(key(GLFW_KEY_LEFT_CONTROL, GLFW_PRESS));
  tap(feed, GLFW_KEY_A, GLFW_MOD_CONTROL);
  feed.add(key(GLFW_KEY_LEFT_CONTROL, GLFW_RELEASE));
  tap(feed, '8');
  EXPECT_EQ(frames_of(feed), (std::vector<std::string>{"<ctrl><all>", "</all></ctrl>8"}));
}

TEST(ViewerKeyFeed, AClickAfterAKeyWaitsForItsFrame) {
  KeyFeed feed;
  tap(feed, '1');
  tap(feed, GLFW_KEY_ENTER);
  feed.add(key(GLFW_KEY_LEFT_CONTROL, GLFW_PRESS));
  click(feed);
  click(feed);
  EXPECT_EQ(frames_of(feed),
            (std::vector<std::string>{"1<enter>", "</enter><ctrl><press>", "</press>", "<press>", "</press>"}));
}

}  // namespace
}  // namespace tyndall::viewer
