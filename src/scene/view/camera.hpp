// Turns the parameters of the camera and the sun, in degrees, into matrices and directions.
#pragma once

#include <glm/glm.hpp>

#include "scene/description/scene_params.hpp"
#include "tyndall/effect.hpp"

namespace tyndall::scene {

constexpr double kNearPlane_m = 0.5;

// A view in double precision. The view looks along `forward`; angles in rad.
struct View {
  glm::dvec3 position = {};  // world [m]
  glm::dvec3 right = {1, 0, 0};
  glm::dvec3 up = {0, 1, 0};
  glm::dvec3 forward = {0, 0, -1};
  double tan_half_width = 1.0;  // tangent of half the horizontal field of view
  double tan_half_height = 1.0;
  glm::dvec2 jitter = {};  // shifts the picture by a fraction of a pixel, in clip space
};

// Returns the view for the parameters of a camera. Yaw and pitch are relative to the local horizontal and to north at
// the position of the camera. camera.altitude_m >= 0 replaces the altitude of camera.position_m.
[[nodiscard]] View view_from_params(const CameraParams& camera, double aspect, double radius_m);
// Returns the camera of the public interface: right-handed, looking down -z, with reversed infinite depth (depth = near
// / distance). It is in the frame of `frame_from_world`, which is near the camera, because single precision does not
// suffice far from the origin (src/scene/view/local_frame.hpp).
[[nodiscard]] Camera camera_from_view(const View& view, const glm::dmat4& frame_from_world = glm::dmat4(1.0));
// Returns the product of the matrices of that camera, in the world frame and in double precision.
[[nodiscard]] glm::dmat4 clip_from_world(const View& view);
// Returns the unit vector towards the sun in the frame of the world's origin.
[[nodiscard]] glm::dvec3 direction_to_sun(const SunParams& sun);
// Returns the direction to the sun at a time of a sequence. It rotates about the axis (0.5, 0.3, 0), as in Yusov's demo
// (2013).
[[nodiscard]] glm::dvec3 animated_direction_to_sun(const SunParams& sun, double seconds);

[[nodiscard]] Vec3 to_vec3(const glm::dvec3& v);
[[nodiscard]] Mat4 to_mat4(const glm::dmat4& m);

}  // namespace tyndall::scene
