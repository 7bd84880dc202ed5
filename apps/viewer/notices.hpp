// Messages of the viewer: to the user as toasts and on the console, and to the event log.
#pragma once

#include <chrono>
#include <string>

#include "viewer/event_log.hpp"
#include "viewer/gui/gui.hpp"
#include "viewer/redraw.hpp"

namespace tyndall::viewer {

class Notices {
 public:
  Notices(Gui& gui, Redraw& redraw) : gui_(&gui), redraw_(&redraw) {}

  // Returns the time since the viewer was started [s].
  [[nodiscard]] double now() const;
  [[nodiscard]] EventLog& events() { return log_; }
  // Writes a line to the event log, if there is one.
  void log(const std::string& text) { log_.line(now(), text); }
  // Shows a toast.
  void note(const std::string& text);
  // Shows an error as a toast and on the console.
  void report(const Error& error);

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point started_ = Clock::now();
  EventLog log_;
  Gui* gui_;
  Redraw* redraw_;
};

// Writes "tyndall: error: ..." to the console.
void print_error(const Error& error);

}  // namespace tyndall::viewer
