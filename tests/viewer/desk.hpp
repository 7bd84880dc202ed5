// Runs the viewer in a window on an X server without a screen (Xvfb), with real key presses and pointer movements
// (xdotool). Functions that wait read the log of the viewer.
#pragma once

#include <ios>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tyndall::desk {

// Returns false if Xvfb or xdotool is missing. Tests are then skipped.
[[nodiscard]] bool equipped();

// A line of the log.
struct LogLine {
  std::size_t number;
  std::string text;
};

class Desk {
 public:
  // `name` is the folder for the test's files: log, state and pictures. `width` and `height` are those of the screen in
  // pixels.
  explicit Desk(const std::string& name, int width = 800, int height = 600);
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;
  ~Desk();

  // Opens the viewer with additional arguments. Returns false if there is no first frame.
  bool open(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {});
  // Enables the validation layers, which are slow.
  bool validation = true;
  // Starts a window manager (openbox), which minimising requires. Returns false if it is not installed.
  bool manage();
  // Runs commands of xdotool, separated by blanks.
  void input(const std::string& commands);
  // Returns the number of lines of the log.
  [[nodiscard]] std::size_t lines() const;
  // Waits for a line that contains all of `words`, and returns the first such line from `from` on.
  std::optional<std::string> wait_for(const std::vector<std::string>& words, std::size_t from = 0,
                                      double seconds = 240.0);
  // Waits for such a line, and returns it with its number.
  std::optional<LogLine> wait_for_line(const std::vector<std::string>& words, std::size_t from, double seconds);
  // Waits for such a line, and then until the picture matches the settings.
  bool settles_after(const std::vector<std::string>& words, std::size_t from);
  // Moves the pointer to a place of the window (at a fraction `part` of its width), and waits until the viewer has
  // received it. Returns false if there is no such place.
  bool point_at(const std::string& place, double part = 0.5);
  bool click(const std::string& place, double part = 0.5, int button = 1);
  // Returns the names of all places that can be clicked now.
  [[nodiscard]] std::vector<std::string> place_names() const;
  // Waits until a place is in the window, or with `there` = false until it is not.
  bool wait_for_place(const std::string& place, bool there = true);
  // Ends the X server.
  void end_server();
  // Ends the viewer with Esc. Returns its exit status, or -1.
  int leave();
  // Waits until the viewer has ended by itself. Returns its exit status, or -1.
  int wait_for_end(double seconds);
  // Saves the screen as NAME.png in the folder.
  bool picture(const std::string& name);
  [[nodiscard]] const std::string& folder() const { return folder_; }
  [[nodiscard]] std::string errors() const;  // standard error of the viewer
  [[nodiscard]] std::string window() const { return window_; }
  // Returns the processor time that the viewer has used so far [s].
  [[nodiscard]] double cpu_s() const;

 private:
  struct Rect {
    double x, y, width, height;
  };
  [[nodiscard]] std::map<std::string, Rect> places() const;
  void read_log() const;

  std::string folder_, display_, window_;
  int server_ = -1, viewer_ = -1, manager_ = -1;
  int pointer_[2] = {-1, -1};             // position after the last point_at()
  mutable std::vector<std::string> log_;  // complete lines
  mutable std::streamoff log_read_ = 0;   // bytes of these lines in the file
};

// Returns the whole log.
[[nodiscard]] std::string log_text(const Desk& desk);

}  // namespace tyndall::desk
