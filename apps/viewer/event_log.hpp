// A log of events in the viewer, one on each line, for tests and for bug reports: "0.532 frame 3 640 360".
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "viewer/gui/widgets.hpp"

namespace tyndall::viewer {

class EventLog {
 public:
  EventLog() = default;
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;
  ~EventLog() {
    if (file_ != nullptr) std::fclose(file_);
  }
  // Opens the file; returns false when it cannot be written.
  bool open(const std::string& path);
  [[nodiscard]] bool on() const { return file_ != nullptr; }
  void line(double seconds, const std::string& text);
  // Writes the places of everything that can be clicked to PATH.places, if they have changed.
  void places(const std::vector<Place>& places);

 private:
  std::string path_, places_;
  std::FILE* file_ = nullptr;
};

}  // namespace tyndall::viewer
