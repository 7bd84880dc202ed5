// The state of the GUI, what it shows of the program and what it requests from the viewer.
#pragma once

#include <string>

#include "viewer/scenes/frame_times.hpp"
#include "viewer/scenes/pictures.hpp"
#include "viewer/scenes/scene_work.hpp"

namespace tyndall::viewer {

// The state that the GUI may change besides the settings.
struct GuiState {
  bool hidden = false;  // toggled by F2
  bool help = false;    // toggled by F1
  bool first_run = false;
  bool controls = true, performance = false, views = false;  // windows that are open
  int tab = 0;                                               // tab of the controls to select next; -1: no change
  PictureOptions picture;
  bool edit_right = false;  // the controls change the right side of a comparison
  float resolution_scale = 1.0F;
  int coarseness = 1;
  bool vsync = true;
  bool full_screen = false;
  bool playing = true;  // the animation of the sun is not paused
};

// The requests of the user in this frame.
struct GuiRequests {
  bool save = false, restore = false, screenshot = false, reload_shaders = false, quit = false, play = false;
  bool copy_to_right = false;  // make the right side of the comparison a copy of the left
  std::string scene;           // a scene file, loaded over the defaults
  std::string preset;          // a scene file, loaded over the settings
};

// The camera and its path.
struct FlightFacts {
  double altitude_m = 0.0, speed_m_s = 0.0;
  bool has_path = false, path_playing = false;
  double path_s = 0.0, path_end_s = 0.0;
};

// The state of the program that the GUI shows.
struct GuiFacts {
  const SceneFacts* scene = nullptr;  // the left scene
  const FrameTimes* times = nullptr;
  std::string device, state_file, present_mode;
  VkExtent2D window = {}, picture = {};
  Progress tables = {};
  bool creating = false;
  std::string shader_message;  // the compiler's message of the last rebuild that failed
  FlightFacts flight;
  double now = 0.0;
};

}  // namespace tyndall::viewer
