#include "scene/view/camera.hpp"

#include <cmath>

#include "math/angles.hpp"
#include "scene/description/map_projection.hpp"

namespace tyndall::scene {
View view_from_params(const CameraParams& camera, double aspect, double radius_m) {
  View view;
  view.position = to_glm(camera.position_m);
  if (camera.altitude_m >= 0.0F) view.position = at_altitude(view.position, camera.altitude_m, radius_m);
  const glm::dvec3 zenith = up_of(view.position, radius_m);
  const glm::dvec3 east = east_of(zenith);
  const glm::dvec3 north = glm::cross(zenith, east);
  const double yaw = camera.yaw_deg * kRadPerDeg;
  const double pitch = camera.pitch_deg * kRadPerDeg;
  const glm::dvec3 heading = north * std::cos(yaw) + east * std::sin(yaw);
  view.forward = heading * std::cos(pitch) + zenith * std::sin(pitch);
  view.right = east * std::cos(yaw) - north * std::sin(yaw);
  view.up = glm::cross(view.right, view.forward);
  view.tan_half_height = std::tan(0.5 * camera.fov_deg * kRadPerDeg);
  view.tan_half_width = view.tan_half_height * aspect;
  return view;
}

namespace {

glm::dmat4 world_from_view(const View& view) {
  glm::dmat4 out(1.0);
  out[0] = glm::dvec4(view.right, 0.0);
  out[1] = glm::dvec4(view.up, 0.0);
  out[2] = glm::dvec4(-view.forward, 0.0);
  out[3] = glm::dvec4(view.position, 1.0);
  return out;
}

glm::dmat4 clip_from_view(const View& view) {
  glm::dmat4 out(0.0);
  out[0][0] = 1.0 / view.tan_half_width;
  out[1][1] = -1.0 / view.tan_half_height;  // Vulkan's y points down
  out[2][0] = -view.jitter.x;               // times -z, which becomes w
  out[2][1] = -view.jitter.y;
  out[2][3] = -1.0;
  out[3][2] = kNearPlane_m;
  return out;
}

}  // namespace

Camera camera_from_view(const View& view, const glm::dmat4& frame_from_world) {
  return {to_mat4(frame_from_world * world_from_view(view)), to_mat4(clip_from_view(view))};
}

glm::dmat4 clip_from_world(const View& view) { return clip_from_view(view) * glm::inverse(world_from_view(view)); }

glm::dvec3 direction_to_sun(const SunParams& sun) {
  const double elevation = sun.elevation_deg * kRadPerDeg;
  const double azimuth = sun.azimuth_deg * kRadPerDeg;
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation), -std::cos(elevation) * std::cos(azimuth)};
}

glm::dvec3 animated_direction_to_sun(const SunParams& sun, double seconds) {
  const glm::dvec3 start = direction_to_sun(sun);
  if (!sun.animate) return start;
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.5, 0.3, 0.0));
  const double angle = sun.animate_speed_deg * kRadPerDeg * seconds;
  // Rodrigues' rotation formula.
  return glm::normalize(start * std::cos(angle) + glm::cross(axis, start) * std::sin(angle) +
                        axis * glm::dot(axis, start) * (1.0 - std::cos(angle)));
}

Vec3 to_vec3(const glm::dvec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Mat4 to_mat4(const glm::dmat4& m) {
  Mat4 out;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) out.m[4 * column + row] = static_cast<float>(m[column][row]);
  }
  return out;
}

}  // namespace tyndall::scene
