// A desk for tests of the viewer: an X server without a screen (Xvfb), the viewer in a window on it, and real key
// presses and pointer movements (xdotool). Everything waits for what the viewer's log says.
#pragma once

#include <ios>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tyndall::desk {

// False where Xvfb or xdotool are missing: tests are skipped then.
[[nodiscard]] bool equipped();

// A line of the viewer's log.
struct LogLine {
  std::size_t number;
  std::string text;
};

class Desk {
 public:
  // `name` is that of the folder for what the test leaves: log, state, pictures. The screen's size is in pixels.
  explicit Desk(const std::string& name, int width = 800, int height = 600);
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;
  ~Desk();

  // Opens the viewer with these arguments besides; false when no first frame came.
  bool open(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {});
  // Whether the validation layers listen; they take their time.
  bool validation = true;
  // Starts a window manager (openbox), which takes what needs one, as minimising does; false where there is none.
  bool manage();
  // Runs commands of xdotool, split at blanks.
  void input(const std::string& commands);
  // The number of the log's lines so far.
  [[nodiscard]] std::size_t lines() const;
  // The first line from `from` on that contains all of `words`; waits for it.
  std::optional<std::string> wait_for(const std::vector<std::string>& words, std::size_t from = 0,
                                      double seconds = 240.0);
  // The same with the line's number.
  std::optional<LogLine> wait_for_line(const std::vector<std::string>& words, std::size_t from, double seconds);
  // Waits for such a line and then until the picture is that of the settings.
  bool settles_after(const std::vector<std::string>& words, std::size_t from);
  // Moves the pointer to the middle of something in the window, or to a part of its width, and waits until the viewer
  // has seen it; false when it is not there.
  bool point_at(const std::string& place, double part = 0.5);
  bool click(const std::string& place, double part = 0.5, int button = 1);
  // Everything that can be clicked now.
  [[nodiscard]] std::vector<std::string> place_names() const;
  // Waits until a place is in the window, or with `there` = false until it is not.
  bool wait_for_place(const std::string& place, bool there = true);
  // Ends the X server.
  void end_server();
  // Leaves by Esc; the exit status, or -1.
  int leave();
  // Waits for the end by itself.
  int wait_for_end(double seconds);
  // What is on the screen, as NAME.png in the folder.
  bool picture(const std::string& name);
  [[nodiscard]] const std::string& folder() const { return folder_; }
  [[nodiscard]] std::string errors() const;  // what the viewer has printed
  [[nodiscard]] std::string window() const { return window_; }
  // Time of a processor that the viewer has used so far [s].
  [[nodiscard]] double cpu_s() const;

 private:
  struct Rect {
    double x, y, width, height;
  };
  [[nodiscard]] std::map<std::string, Rect> places() const;
  void read_log() const;

  std::string folder_, display_, window_;
  int server_ = -1, viewer_ = -1, manager_ = -1;
  int pointer_[2] = {-1, -1};             // where point_at() has moved it
  mutable std::vector<std::string> log_;  // its whole lines so far
  mutable std::streamoff log_read_ = 0;   // what they take of the file [bytes]
};

// The whole log of the viewer so far.
[[nodiscard]] std::string log_text(const Desk& desk);

}  // namespace tyndall::desk
