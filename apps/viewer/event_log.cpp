#include "viewer/event_log.hpp"

#include "files/files.hpp"

namespace tyndall::viewer {

bool EventLog::open(const std::string& path) {
  path_ = path;
  file_ = std::fopen(path.c_str(), "w");
  return file_ != nullptr;
}

void EventLog::line(double seconds, const std::string& text) {
  if (file_ == nullptr) return;
  std::fprintf(file_, "%.3f %s\n", seconds, text.c_str());
  std::fflush(file_);
}

void EventLog::places(const std::vector<Place>& places) {
  if (file_ == nullptr) return;
  std::string text;
  for (const Place& p : places) {
    char numbers[96];
    std::snprintf(numbers, sizeof numbers, "%.0f %.0f %.0f %.0f ", static_cast<double>(p.x), static_cast<double>(p.y),
                  static_cast<double>(p.width), static_cast<double>(p.height));
    text += numbers + p.name + "\n";
  }
  if (text == places_) return;
  places_ = std::move(text);
  // The file is replaced as a whole, since a test may be reading it. If that fails, the test finds it missing.
  if (Result<void> written = files::write_file(path_ + ".places", places_); !written) places_.clear();
}

}  // namespace tyndall::viewer
