// Changes without user input, for tests and soaks: every parameter to both ends of its range, or random parameters.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "config/settings.hpp"
#include "viewer/gui/gui_state.hpp"

namespace tyndall::viewer {

class Script {
 public:
  enum class Kind { none, walk, soak };
  Script() = default;
  // Reads ViewerDesc::script: "walk", "soak=SECONDS" or "soak-frames=COUNT"; any other text gives no script.
  Script(const std::string& text, const config::Settings& start);

  [[nodiscard]] bool on() const { return kind_ != Kind::none && !done_; }
  [[nodiscard]] bool done() const { return done_; }
  // Makes the next change; call it when the previous one has been drawn. `frames`: of the scene so far. Returns what
  // was changed, for the log.
  std::string advance(config::Settings& settings, GuiState& gui, double now, std::uint64_t frames);

 private:
  std::string walk(config::Settings& settings);
  std::string soak(config::Settings& settings, GuiState& gui);

  Kind kind_ = Kind::none;
  double seconds_ = 0.0;
  std::uint64_t frames_ = 0;
  double begun_ = -1.0;
  bool done_ = false;
  config::Settings start_;
  std::size_t next_ = 0;
  std::uint64_t changes_ = 0;
  std::mt19937 random_{20130703};
};

}  // namespace tyndall::viewer
