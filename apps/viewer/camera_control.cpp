#include "viewer/camera_control.hpp"

#include <algorithm>
#include <cmath>

#include "scene/description/map_projection.hpp"
#include "scene/view/camera.hpp"

namespace tyndall::viewer {
namespace {

constexpr double kDegPerRad = 57.29577951308232;
constexpr double kSunTurn_deg = 180.0;  // how far a drag over the height of the window turns the sun

double wrapped(double angle_deg) {
  const double turned = std::fmod(angle_deg, 360.0);
  return turned < 0.0 ? turned + 360.0 : turned;
}

struct Horizon {
  glm::dvec3 up, east, north;
};

// Returns the local axes at a position, as scene::view_from_params() does.
Horizon horizon_at(const glm::dvec3& position, double radius_m) {
  Horizon h;
  h.up = scene::up_of(position, radius_m);
  h.east = scene::east_of(h.up);
  h.north = glm::cross(h.up, h.east);
  return h;
}

// Returns `v` turned by the smallest rotation from `from` to `to`, which are unit vectors and not opposite.
glm::dvec3 carried(const glm::dvec3& v, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 axis = glm::cross(from, to);
  const double cosine = glm::dot(from, to);
  return v * cosine + glm::cross(axis, v) + axis * (glm::dot(axis, v) / (1.0 + cosine));
}

}  // namespace

CameraState camera_from_params(const scene::CameraParams& params, double radius_m) {
  const scene::View view = scene::view_from_params(params, 1.0, radius_m);
  return {view.position, params.yaw_deg, params.pitch_deg, params.fov_deg};
}

void camera_to_params(const CameraState& camera, scene::CameraParams& params) {
  params.position_m = {camera.position.x, camera.position.y, camera.position.z};
  params.altitude_m = -1.0F;
  params.yaw_deg = static_cast<float>(camera.yaw_deg);
  params.pitch_deg = static_cast<float>(camera.pitch_deg);
  params.fov_deg = static_cast<float>(camera.fov_deg);
}

double flight_speed(double height_m, bool fast) {
  const double speed = 30.0 + 0.4 * std::max(height_m, 0.0);
  return fast ? 6.0 * speed : speed;
}

CameraState moved(const CameraState& camera, const Motion& motion, double seconds, double speed, double radius_m) {
  scene::CameraParams direction;
  camera_to_params(camera, direction);
  const Horizon before = horizon_at(camera.position, radius_m);
  const double yaw = camera.yaw_deg / kDegPerRad;
  const double pitch = camera.pitch_deg / kDegPerRad;
  const glm::dvec3 heading = before.north * std::cos(yaw) + before.east * std::sin(yaw);
  const glm::dvec3 right = before.east * std::cos(yaw) - before.north * std::sin(yaw);
  const glm::dvec3 forward = heading * std::cos(pitch) + before.up * std::sin(pitch);
  glm::dvec3 way = right * motion.right + before.up * motion.up + forward * motion.forward;
  if (glm::length(way) > 1.0) way = glm::normalize(way);
  CameraState out = camera;
  // A straight step would leave the ground of a curved planet, so the horizontal part follows the curvature.
  const double climb = glm::dot(way, before.up) * speed * seconds;
  const double altitude = scene::altitude_of(camera.position, radius_m);
  out.position += way * (speed * seconds);
  const glm::dvec3 centre(0.0, -radius_m, 0.0);
  out.position =
      centre + glm::normalize(out.position - centre) * (radius_m + std::max(altitude + climb, -0.5 * radius_m));
  const Horizon after = horizon_at(out.position, radius_m);
  // The direction to the right is always horizontal, so it defines the yaw even when looking straight down.
  const glm::dvec3 now = carried(right, before.up, after.up);
  out.yaw_deg = wrapped(std::atan2(-glm::dot(now, after.north), glm::dot(now, after.east)) * kDegPerRad);
  return out;
}

CameraState above_ground(const CameraState& camera, double ground_m, double radius_m) {
  CameraState out = camera;
  const double altitude = scene::altitude_of(camera.position, radius_m);
  const double wanted =
      std::clamp(altitude, ground_m + kMinHeight_m, std::max(kMaxAltitude_m, ground_m + kMinHeight_m));
  if (wanted != altitude) out.position += scene::up_of(camera.position, radius_m) * (wanted - altitude);
  return out;
}

CameraState turned(const CameraState& camera, double dx_px, double dy_px, double height_px) {
  CameraState out = camera;
  const double deg_per_px = camera.fov_deg / std::max(height_px, 1.0);
  // Away from the horizon a change of yaw moves the picture less.
  const double slant = std::max(std::cos(camera.pitch_deg / kDegPerRad), 0.25);
  out.yaw_deg = wrapped(camera.yaw_deg - dx_px * deg_per_px / slant);
  out.pitch_deg = std::clamp(camera.pitch_deg + dy_px * deg_per_px, -kMaxPitch_deg, kMaxPitch_deg);
  return out;
}

CameraState zoomed(const CameraState& camera, double notches) {
  CameraState out = camera;
  out.fov_deg = std::clamp(camera.fov_deg * std::pow(0.9, notches), kFovRange_deg[0], kFovRange_deg[1]);
  return out;
}

scene::SunParams sun_turned(const scene::SunParams& sun, double dx_px, double dy_px, double height_px) {
  scene::SunParams out = sun;
  const double deg_per_px = kSunTurn_deg / std::max(height_px, 1.0);
  out.azimuth_deg = static_cast<float>(wrapped(static_cast<double>(sun.azimuth_deg) + dx_px * deg_per_px));
  out.elevation_deg =
      static_cast<float>(std::clamp(static_cast<double>(sun.elevation_deg) - dy_px * deg_per_px, -90.0, 90.0));
  return out;
}

}  // namespace tyndall::viewer
