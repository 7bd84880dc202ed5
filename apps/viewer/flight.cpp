#include "viewer/flight.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "files/text.hpp"
#include "scene/description/map_projection.hpp"
#include "scene/description/placed_sun.hpp"

namespace tyndall::viewer {
namespace {

constexpr int kFlightKeys[] = {GLFW_KEY_W, GLFW_KEY_A, GLFW_KEY_S, GLFW_KEY_D, GLFW_KEY_Q, GLFW_KEY_E};

const char* name_of(Button button) { return button == Button::left ? "left" : "right"; }

}  // namespace

void Flight::handle_pointer(const Event& event, config::Settings& settings) {
  const bool over_gui = ImGui::GetIO().WantCaptureMouse;
  bool& dragging = event.button == Button::left ? dragging_view_ : dragging_sun_;
  switch (event.kind) {
    case Event::Kind::press:
      notices_->log(std::string("press ") + name_of(event.button));
      pointer_x_ = event.x;
      pointer_y_ = event.y;
      if (!over_gui) dragging = true;
      break;
    case Event::Kind::release:
      notices_->log(std::string("release ") + name_of(event.button));
      dragging = false;
      break;
    case Event::Kind::move: {
      const double height = std::max(window_->size().height, 1U);
      const double dx = event.x - std::exchange(pointer_x_, event.x);
      const double dy = event.y - std::exchange(pointer_y_, event.y);
      if (notices_->events().on()) {
        pointer_text_ = "pointer " + files::number_text(event.x) + " " + files::number_text(event.y);
      }
      if (dragging_view_) camera_ = turned(camera_, dx, dy, height);
      if (dragging_sun_) {
        // The drag begins at the positions of the sun and the moon in the picture. From then on they are no longer
        // computed from a time.
        if (Result<scene::MoonParams> moon =
                scene::placed_moon(settings.scene.moon, settings.scene.sun, terrain_place_);
            moon) {
          settings.scene.moon = moon.value();
        }
        settings.scene.moon.by_date = false;
        if (Result<scene::SunParams> sun = scene::placed_sun(settings.scene.sun, terrain_place_); sun) {
          settings.scene.sun = sun.value();
        }
        settings.scene.sun.time.clear();
        settings.scene.sun.refraction = false;
        settings.scene.sun = sun_turned(settings.scene.sun, dx, dy, height);
      }
      break;
    }
    case Event::Kind::wheel:
      if (!over_gui) camera_ = zoomed(camera_, event.y);
      break;
    case Event::Kind::key: break;
  }
}

std::string Flight::take_pointer_text() { return std::exchange(pointer_text_, {}); }

void Flight::advance(double seconds, const SceneFacts& facts, config::Settings& settings) {
  terrain_place_ = facts.elevations != nullptr ? facts.elevations->place() : std::nullopt;
  follow_path(seconds, facts, settings);
  fly(seconds, facts, settings);
}

void Flight::toggle_path(const config::Settings& settings) {
  if (settings.path.empty()) {
    notices_->note("This scene has no camera flight");
    return;
  }
  path_playing_ = !path_playing_;
  if (!settings.path.loop && path_s_ >= settings.path.duration_s()) path_s_ = 0.0;
  // A pose replaces moon.by_date by the angles of the moon, so that the settings do not have it any more.
  moon_by_date_ = moon_by_date_ || settings.scene.moon.by_date;
  notices_->log(path_playing_ ? "path begins" : "path stops");
}

void Flight::reset_path() {
  path_s_ = 0.0;
  moon_by_date_ = false;
  path_playing_ = false;
}

// Moves camera and sun along the path, as `render` does. Stops when the user steers.
void Flight::follow_path(double seconds, const SceneFacts& facts, config::Settings& settings) {
  if (!path_playing_) return;
  const bool steered = dragging_view_ || dragging_sun_ || steering();
  const double end_s = settings.path.duration_s();
  if (steered || settings.path.empty() || (!settings.path.loop && path_s_ >= end_s)) {
    path_playing_ = false;
    notices_->log("path stops");
    return;
  }
  if (facts.can_render) path_s_ += seconds;
  // A path with dates takes its place from the elevation file when the scene file gives none.
  if (settings.path.place_text.empty() && facts.elevations != nullptr && facts.elevations->place()) {
    settings.path.place = *facts.elevations->place();
  }
  if (!settings.path.loop) path_s_ = std::min(path_s_, end_s);
  scene::SceneParams base = settings.scene;
  base.moon.by_date = base.moon.by_date || (moon_by_date_ && settings.path.has_dates());
  settings.scene = scene::pose_at(settings.path, path_s_, base, settings.effect.planet.radius_m);
  redraw_->request(2);
}

// Returns the elevation of the ground below the camera [m].
double Flight::ground_below(const SceneFacts& facts) const {
  if (facts.elevations == nullptr) return 0.0;
  return scene::ground_height(*facts.elevations, scene::up_of(camera_.position, facts.radius_m), facts.radius_m);
}

bool Flight::steering() const {
  return std::any_of(std::begin(kFlightKeys), std::end(kFlightKeys), [this](int key) { return window_->held(key); });
}

void Flight::fly(double seconds, const SceneFacts& facts, config::Settings& settings) {
  take_camera(settings);
  const double radius_m = settings.effect.planet.radius_m;
  height_m_ = scene::altitude_of(camera_.position, radius_m) - ground_below(facts);
  Motion motion;
  if (!ImGui::GetIO().WantTextInput) {
    const auto axis = [this](int more, int less) {
      return (window_->held(more) ? 1.0 : 0.0) - (window_->held(less) ? 1.0 : 0.0);
    };
    motion.forward = axis(GLFW_KEY_W, GLFW_KEY_S);
    motion.right = axis(GLFW_KEY_D, GLFW_KEY_A);
    motion.up = axis(GLFW_KEY_E, GLFW_KEY_Q);
    motion.fast = window_->held(GLFW_KEY_LEFT_SHIFT) || window_->held(GLFW_KEY_RIGHT_SHIFT);
  }
  speed_m_s_ = flight_speed(height_m_, motion.fast);
  if (motion.any()) {
    camera_ = moved(camera_, motion, seconds, speed_m_s_, radius_m);
    redraw_->note_motion(notices_->now());
  }
  if (facts.can_render) camera_ = above_ground(camera_, ground_below(facts), radius_m);
  put_camera(settings);
}

void Flight::take_camera(const config::Settings& settings) {
  const scene::CameraParams& p = settings.scene.camera;
  const scene::CameraParams& c = camera_params_;
  const bool same = p.position_m == c.position_m && p.altitude_m == c.altitude_m && p.yaw_deg == c.yaw_deg &&
                    p.pitch_deg == c.pitch_deg && p.fov_deg == c.fov_deg;
  if (has_camera_ && same) return;
  camera_ = camera_from_params(p, settings.effect.planet.radius_m);
  camera_params_ = p;
  has_camera_ = true;
}

void Flight::put_camera(config::Settings& settings) {
  const CameraState before = camera_from_params(camera_params_, settings.effect.planet.radius_m);
  const bool has_moved = camera_.yaw_deg != before.yaw_deg || camera_.pitch_deg != before.pitch_deg ||
                         camera_.fov_deg != before.fov_deg || glm::distance(camera_.position, before.position) > 1.0e-4;
  if (!has_moved) return;
  camera_to_params(camera_, settings.scene.camera);
  camera_params_ = settings.scene.camera;
}

}  // namespace tyndall::viewer
