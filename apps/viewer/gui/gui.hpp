// The GUI's state, what it asks the viewer to do, and its parts. Everything about parameters comes from the table.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "viewer/gui/widgets.hpp"
#include "viewer/platform/files.hpp"
#include "viewer/scenes/pictures.hpp"
#include "viewer/scenes/scene_work.hpp"

namespace tyndall::viewer {

struct Toast {
  std::string text;
  double until = 0.0;  // [s] on the viewer's clock
  bool bad = false;
};

// Milliseconds of the last frames, for the graph.
struct FrameTimes {
  static constexpr std::size_t kCount = 128;
  std::array<float, kCount> gpu = {};    // all passes
  std::array<float, kCount> whole = {};  // from one frame of the scene to the next
  std::size_t next = 0;
  std::vector<scene::PassTime> passes;  // of the last frame, smoothed
  void add(const std::vector<scene::PassTime>& times, double whole_ms);
};

// What the GUI may change besides the settings.
struct GuiState {
  bool hidden = false;  // F2
  bool help = false;    // F1
  bool first_run = false;
  bool controls = true, performance = false, views = false;
  int tab = 0;  // of the controls, to be selected next; -1: leave it
  PictureOptions picture;
  bool edit_right = false;  // the controls change the right side of a comparison
  float resolution_scale = 1.0F;
  int coarseness = 1;
  bool vsync = true;
  bool full_screen = false;
  bool playing = true;  // the sun's own motion
};

// What was asked for in this frame.
struct GuiRequests {
  bool save = false, restore = false, screenshot = false, reload_shaders = false, quit = false, play = false;
  bool copy_to_right = false;  // the right side of the comparison becomes what the left is
  std::string scene;           // a scene file over the defaults
  std::string preset;          // a scene file over what there is
};

// What the GUI shows of the program.
struct GuiFacts {
  const SceneFacts* scene = nullptr;  // of the left side
  const FrameTimes* times = nullptr;
  std::string device, state_file, present_mode;
  VkExtent2D window = {}, picture = {};
  Progress tables = {}, pipelines = {};
  bool creating = false;
  std::string shader_message;  // of the last rebuild that failed
  bool slow_device = false;
  bool has_path = false, flying_path = false;
  double path_s = 0.0, path_end_s = 0.0;
  double altitude_m = 0.0, height_m = 0.0, speed_m_s = 0.0;
  double now = 0.0;
};

class Gui {
 public:
  GuiState state;
  Widgets widgets;

  void start();
  // `left` and `right` are the sides of the comparison; without one, only the left.
  void draw(config::Settings& left, config::Settings& right, const GuiFacts& facts, GuiRequests& requests);
  void toast(std::string text, bool bad, double now);
  [[nodiscard]] bool showing_toasts(double now) const { return !toasts_.empty() && toasts_.back().until > now; }

 private:
  void menu(config::Settings& settings, const GuiFacts& facts, GuiRequests& requests);
  void controls(config::Settings& settings, GuiRequests& requests);
  void basic(config::Settings& settings);
  void additional(config::Settings& settings);
  void tone_mapping(config::Settings& settings);
  void atmosphere(config::Settings& settings);
  void everything(config::Settings& settings);
  void performance(const GuiFacts& facts);
  void views(const GuiFacts& facts, GuiRequests& requests);
  void divider(const GuiFacts& facts);
  void status(const GuiFacts& facts);
  void help(const GuiFacts& facts);
  void first_run(const GuiFacts& facts);
  void toasts(const GuiFacts& facts);
  void edit(config::Settings& settings, std::initializer_list<const char*> keys);

  std::vector<SceneFile> scenes_, presets_;
  std::vector<Toast> toasts_;
};

}  // namespace tyndall::viewer
