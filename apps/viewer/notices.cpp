#include "viewer/notices.hpp"

#include <cstdio>

#include "files/text.hpp"

namespace tyndall::viewer {

double Notices::now() const { return std::chrono::duration<double>(Clock::now() - started_).count(); }

void Notices::note(const std::string& text) {
  log("note " + text);
  gui_->toast(text, false, now());
  redraw_->request(2);
}

void Notices::report(const Error& error) {
  log("error " + error.message);
  gui_->toast(error.message, true, now());
  print_error(error);
}

void print_error(const Error& error) {
  std::fprintf(stderr, "tyndall: error: %s\n", files::one_line(error.message, 2000).c_str());
}

}  // namespace tyndall::viewer
