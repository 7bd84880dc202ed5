// Moves the camera and the sun: by keys and pointer, and along the path of a scene file. The camera parameters of the
// settings follow the camera, and the camera follows them when something else changes them.
#pragma once

#include <optional>
#include <string>

#include "config/settings.hpp"
#include "viewer/camera_control.hpp"
#include "viewer/notices.hpp"
#include "viewer/platform/window.hpp"
#include "viewer/scenes/scene_work.hpp"

namespace tyndall::viewer {

class Flight {
 public:
  Flight(Window& window, Notices& notices, Redraw& redraw) : window_(&window), notices_(&notices), redraw_(&redraw) {}

  // Applies a pointer event: dragging turns the camera or the sun, the wheel zooms.
  void handle_pointer(const Event& event, config::Settings& settings);
  // Advances the path, if it is played, and then the flight by keys. `seconds`: since the last call.
  void advance(double seconds, const SceneFacts& facts, config::Settings& settings);
  // Takes over the camera of the settings if something other than the flight has changed it.
  void take_camera(const config::Settings& settings);

  // Plays the path of the settings, or stops it.
  void toggle_path(const config::Settings& settings);
  // Returns to the start of the path, and stops it.
  void reset_path();

  // Returns whether keys or the path move the camera.
  [[nodiscard]] bool moving() const { return steering() || path_playing_; }
  [[nodiscard]] bool path_playing() const { return path_playing_; }
  [[nodiscard]] double path_s() const { return path_s_; }
  [[nodiscard]] const CameraState& camera() const { return camera_; }
  [[nodiscard]] double height_m() const { return height_m_; }  // height of the camera above the ground
  [[nodiscard]] double speed_m_s() const { return speed_m_s_; }
  // Returns "pointer X Y" if the pointer has moved since the last call, for the event log; otherwise an empty text.
  [[nodiscard]] std::string take_pointer_text();

 private:
  void follow_path(double seconds, const SceneFacts& facts, config::Settings& settings);
  void fly(double seconds, const SceneFacts& facts, config::Settings& settings);
  void put_camera(config::Settings& settings);
  [[nodiscard]] bool steering() const;
  [[nodiscard]] double ground_below(const SceneFacts& facts) const;

  Window* window_;
  Notices* notices_;
  Redraw* redraw_;
  CameraState camera_;
  scene::CameraParams camera_params_;  // the parameters that put_camera() wrote last
  bool has_camera_ = false;            // camera_params_ holds a camera
  double speed_m_s_ = 0.0, height_m_ = 0.0;
  bool dragging_view_ = false, dragging_sun_ = false;
  double pointer_x_ = 0.0, pointer_y_ = 0.0;
  std::string pointer_text_;
  std::optional<scene::Place> terrain_place_;  // place of the elevation file
  bool path_playing_ = false;
  bool moon_by_date_ = false;  // moon.by_date when the path began
  double path_s_ = 0.0;
};

}  // namespace tyndall::viewer
