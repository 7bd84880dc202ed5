// What the hands do to the camera and the sun, and the flight along a path.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <iterator>

#include "files/text.hpp"
#include "scene/description/map_projection.hpp"
#include "viewer/viewer_state.hpp"

namespace tyndall::viewer {
namespace {

constexpr int kFlightKeys[] = {GLFW_KEY_W, GLFW_KEY_A, GLFW_KEY_S, GLFW_KEY_D, GLFW_KEY_Q, GLFW_KEY_E};

}  // namespace

void Viewer::handle_events(const std::vector<Event>& events) {
  const ImGuiIO& io = ImGui::GetIO();
  const double height = std::max(window_.size().height, 1U);
  for (const Event& event : events) {
    switch (event.kind) {
      case Event::Kind::key:
        if (!io.WantTextInput || event.key == GLFW_KEY_ESCAPE) handle_key(event.key);
        break;
      case Event::Kind::press:
        log(event.button == Button::left ? "press left" : "press right");
        pointer_[0] = event.x;
        pointer_[1] = event.y;
        if (io.WantCaptureMouse) break;
        (event.button == Button::left ? dragging_view_ : dragging_sun_) = true;
        break;
      case Event::Kind::release:
        log(event.button == Button::left ? "release left" : "release right");
        (event.button == Button::left ? dragging_view_ : dragging_sun_) = false;
        break;
      case Event::Kind::move: {
        const double dx = event.x - pointer_[0];
        const double dy = event.y - pointer_[1];
        pointer_[0] = event.x;
        pointer_[1] = event.y;
        if (log_.on()) pointer_seen_ = "pointer " + files::number_text(event.x) + " " + files::number_text(event.y);
        if (dragging_view_) camera_ = turned(camera_, dx, dy, height);
        if (dragging_sun_) settings_.scene.sun = sun_turned(settings_.scene.sun, dx, dy, height);
        break;
      }
      case Event::Kind::wheel:
        if (!io.WantCaptureMouse) camera_ = zoomed(camera_, event.y);
        break;
    }
  }
}

// The flight of the scene file, by the same function as in `render`; hands stop it.
void Viewer::follow_path(double seconds) {
  if (!flying_path_) return;
  const bool hands = dragging_view_ || dragging_sun_ || flying();
  const double end_s = settings_.path.duration_s();
  if (hands || settings_.path.empty() || (!settings_.path.loop && path_s_ >= end_s)) {
    flying_path_ = false;
    log("path stops");
    return;
  }
  const SceneFacts facts = left_->facts();
  if (facts.can_render) path_s_ += seconds;
  // A flight by date takes its place from the elevation file when the scene file gives none.
  if (settings_.path.place_text.empty() && facts.elevations != nullptr && facts.elevations->place()) {
    settings_.path.place = *facts.elevations->place();
  }
  if (!settings_.path.loop) path_s_ = std::min(path_s_, end_s);
  settings_.scene = scene::pose_at(settings_.path, path_s_, settings_.scene, settings_.effect.planet.radius_m);
  frames_to_draw_ = std::max(frames_to_draw_, 2);
}

// Elevation of the ground below the camera [m].
double Viewer::ground_below(const SceneFacts& facts) const {
  return facts.elevations != nullptr
             ? scene::ground_height(*facts.elevations, scene::up_of(camera_.position, facts.radius_m), facts.radius_m)
             : 0.0;
}

bool Viewer::flying() const {
  return std::any_of(std::begin(kFlightKeys), std::end(kFlightKeys), [this](int key) { return window_.held(key); });
}

void Viewer::fly(double seconds) {
  take_camera();
  const double radius_m = settings_.effect.planet.radius_m;
  const double altitude = scene::altitude_of(camera_.position, radius_m);
  height_m_ = altitude - ground_below(left_->facts());
  Motion motion;
  if (!ImGui::GetIO().WantTextInput) {
    const auto axis = [this](int more, int less) {
      return (window_.held(more) ? 1.0 : 0.0) - (window_.held(less) ? 1.0 : 0.0);
    };
    motion.forward = axis(GLFW_KEY_W, GLFW_KEY_S);
    motion.right = axis(GLFW_KEY_D, GLFW_KEY_A);
    motion.up = axis(GLFW_KEY_E, GLFW_KEY_Q);
    motion.fast = window_.held(GLFW_KEY_LEFT_SHIFT) || window_.held(GLFW_KEY_RIGHT_SHIFT);
  }
  speed_m_s_ = flight_speed(height_m_, motion.fast);
  if (motion.any()) {
    camera_ = moved(camera_, motion, seconds, speed_m_s_, radius_m);
    last_activity_ = now();
    frames_to_draw_ = std::max(frames_to_draw_, 2);
  }
  if (left_->facts().can_render) camera_ = above_ground(camera_, ground_below(left_->facts()), radius_m);
  put_camera();
}

// Takes the camera from the settings, when something else than put_camera() has changed them.
void Viewer::take_camera() {
  const scene::CameraParams& p = settings_.scene.camera;
  const scene::CameraParams& c = camera_params_;
  const bool same = first_frame_told_ || frames_ > 0 || last_step_ > 0.0
                        ? p.position_m == c.position_m && p.altitude_m == c.altitude_m && p.yaw_deg == c.yaw_deg &&
                              p.pitch_deg == c.pitch_deg && p.fov_deg == c.fov_deg
                        : false;
  if (same) return;
  camera_ = camera_from_params(p, settings_.effect.planet.radius_m);
  camera_params_ = p;
}

void Viewer::put_camera() {
  const CameraState before = camera_from_params(camera_params_, settings_.effect.planet.radius_m);
  const bool moved_at_all = camera_.yaw_deg != before.yaw_deg || camera_.pitch_deg != before.pitch_deg ||
                            camera_.fov_deg != before.fov_deg ||
                            glm::distance(camera_.position, before.position) > 1.0e-4;
  if (!moved_at_all) return;
  camera_to_params(camera_, settings_.scene.camera);
  camera_params_ = settings_.scene.camera;
}

}  // namespace tyndall::viewer
