// One widget for one parameter, made from its row in the table: kind, range, unit, choices and meaning.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/settings.hpp"

namespace tyndall::viewer {

// Where something that can be clicked stands in the window [px]: for tests that use the real mouse.
struct Place {
  std::string name;
  float x = 0.0F, y = 0.0F, width = 0.0F, height = 0.0F;
};

class Widgets {
 public:
  bool with_group = true;  // in the labels, where they are one word

  // The values before the edit; forget the places of the last frame.
  void begin_frame();
  // Draws the widget of a parameter and changes `settings`. True when it did.
  bool edit(const config::Row& row, config::Settings& settings);
  bool edit(std::string_view key, config::Settings& settings);
  // Three coefficients as a colour, full brightness being `scale` [1/m].
  bool edit_color(std::string_view key, config::Settings& settings, float scale);
  // Remembers where the last item of ImGui stands.
  void place(std::string name);
  [[nodiscard]] const std::vector<Place>& places() const { return places_; }
  // Whether a widget is held: what is dear to follow can wait until it is let go.
  [[nodiscard]] bool dragging() const { return dragging_; }

 private:
  void place_components(const config::Row& row, const std::string& key, float width);

  std::vector<Place> places_;
  bool dragging_ = false;
};

// "Refinement threshold", from refinement_threshold; the unit is left to the format.
[[nodiscard]] std::string label_of(const config::Row& row, bool with_group);
// Meaning, key, what is allowed and in which unit, the default.
[[nodiscard]] std::string tooltip_of(const config::Row& row);
// Sets a parameter to an end of its range: numbers to their least or largest value, choices to the first or last.
// Nothing for text.
void set_to_end(const config::Row& row, config::Settings& settings, bool largest);

}  // namespace tyndall::viewer
