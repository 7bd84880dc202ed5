// Widgets for parameters, made from their rows in the table: kind, range, unit, choices and meaning.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/settings.hpp"

namespace tyndall::viewer {

// The rectangle of something that can be clicked, in window coordinates [px]. Tests move the pointer there.
struct Place {
  std::string name;
  float x = 0.0F, y = 0.0F, width = 0.0F, height = 0.0F;
};

class Widgets {
 public:
  bool with_group = true;  // add the group's name to labels of one word

  // Forgets the places of the last frame.
  void begin_frame();
  // Draws the widget of a parameter. Returns whether the user has changed `settings` with it.
  bool edit(const config::Row& row, config::Settings& settings);
  bool edit(std::string_view key, config::Settings& settings);
  // Draws three coefficients as a colour; `scale` [1/m] is shown at full brightness.
  bool edit_color(std::string_view key, config::Settings& settings, float scale);
  // Records the place of ImGui's last item.
  void place(std::string name);
  [[nodiscard]] const std::vector<Place>& places() const { return places_; }
  // Returns whether a widget is being dragged: expensive changes can wait until it is released.
  [[nodiscard]] bool dragging() const { return dragging_; }

 private:
  void place_components(const config::Row& row, const std::string& key, float width);

  std::vector<Place> places_;
  bool dragging_ = false;
};

// Returns the label of a parameter, such as "Refinement threshold" for refinement_threshold, without its unit.
[[nodiscard]] std::string label_of(const config::Row& row, bool with_group);
// Returns the tooltip: meaning, key, allowed values with their unit, and default.
[[nodiscard]] std::string tooltip_of(const config::Row& row);
// Sets a parameter to an end of its range: numbers to their smallest or largest value, choices to the first or last.
// Does nothing for text.
void set_to_end(const config::Row& row, config::Settings& settings, bool largest);

}  // namespace tyndall::viewer
