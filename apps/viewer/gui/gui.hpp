// The GUI: menu, windows and overlays over the picture. The appearance of a control follows from its row in the table
// of parameters.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "config/settings.hpp"
#include "viewer/gui/gui_state.hpp"
#include "viewer/gui/widgets.hpp"
#include "viewer/platform/files.hpp"

namespace tyndall::viewer {

// A message over the picture.
struct Toast {
  std::string text;
  double until = 0.0;  // [s] on the viewer's clock
  bool bad = false;
};

class Gui {
 public:
  GuiState state;
  Widgets widgets;

  // Finds the scene files of the menus and sets ImGui's style.
  void start();
  // Draws one frame. `left` and `right` are the sides of the comparison. Without a comparison, `right` is not used.
  void draw(config::Settings& left, config::Settings& right, const GuiFacts& facts, GuiRequests& requests);
  void toast(std::string text, bool bad, double now);
  [[nodiscard]] bool showing_toasts(double now) const {
    return std::any_of(toasts_.begin(), toasts_.end(), [now](const Toast& toast) { return toast.until > now; });
  }

 private:
  void menu(config::Settings& settings, const GuiFacts& facts, GuiRequests& requests);
  void file_menu(const GuiFacts& facts, GuiRequests& requests);
  void scene_menus(GuiRequests& requests);
  void model_menu(config::Settings& settings);
  bool begin_menu(const char* name);
  bool item(const char* name, const char* key, bool* on = nullptr);
  void divider(const GuiFacts& facts);
  void status(const GuiFacts& facts);
  void help(const GuiFacts& facts);
  void first_run(const GuiFacts& facts);
  void toasts(const GuiFacts& facts);

  std::vector<SceneFile> scenes_, presets_;
  std::vector<Toast> toasts_;
};

}  // namespace tyndall::viewer
