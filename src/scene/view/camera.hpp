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
  double tan_half_width = 1.0;  // of the field of view
  double tan_half_height = 1.0;
  glm::dvec2 jitter = {};  // shifts the picture by a fraction of a pixel, in clip space
};

// Yaw and pitch are relative to the local horizontal and north of the camera's place on the planet.
// camera.altitude_m >= 0 replaces the altitude of camera.position_m.
[[nodiscard]] View view_from_params(const CameraParams& camera, double aspect, double radius_m);
// Right-handed, looking down -z, reversed infinite depth: depth = near / distance. In the frame that `frame_from_world`
// leads to, which is close to the camera: floats hold no place far from the origin (src/scene/view/local_frame.hpp).
[[nodiscard]] Camera camera_from_view(const View& view, const glm::dmat4& frame_from_world = glm::dmat4(1.0));
// The product of the two in double precision.
[[nodiscard]] glm::dmat4 clip_from_world(const View& view);
// Unit vector towards the sun in the frame of the world's origin.
[[nodiscard]] glm::dvec3 direction_to_sun(const SunParams& sun);
// The sun of frame `index` of a sequence: it turns about the axis (0.5, 0.3, 0), as in Yusov's demo (2013).
[[nodiscard]] glm::dvec3 animated_direction_to_sun(const SunParams& sun, double seconds);

[[nodiscard]] Vec3 to_vec3(const glm::dvec3& v);
[[nodiscard]] Mat4 to_mat4(const glm::dmat4& m);

}  // namespace tyndall::scene
