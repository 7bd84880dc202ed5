// Movement of the camera and the sun by user input: pure functions of the previous state. Angles in deg, lengths in m.
// The camera flies over a curved planet: "up" always points away from the planet's centre, and the direction of view is
// transported along the path, so that the view is continuous from the ground to orbit.
#pragma once

#include <glm/glm.hpp>

#include "scene/description/scene_params.hpp"

namespace tyndall::viewer {

constexpr double kMinHeight_m = 2.5;      // lowest height of the camera above the ground
constexpr double kMaxAltitude_m = 5.0e7;  // above sea level
constexpr double kMaxPitch_deg = 89.9;    // view up or down
constexpr double kFovRange_deg[2] = {2.0, 150.0};

// A camera in double precision, which resolves centimetres in orbit too.
struct CameraState {
  glm::dvec3 position = {};  // world [m]
  double yaw_deg = 0.0;      // as in CameraParams: relative to the local horizontal and north
  double pitch_deg = 0.0;
  double fov_deg = 45.0;
};

[[nodiscard]] CameraState camera_from_params(const scene::CameraParams& params, double radius_m);
// Writes position, direction and field of view. altitude_m becomes -1: the altitude is that of position_m.
void camera_to_params(const CameraState& camera, scene::CameraParams& params);

// The motion that keys request, each component from -1 to 1: to the camera's right, up, and along the direction of
// view.
struct Motion {
  double right = 0.0, up = 0.0, forward = 0.0;
  bool fast = false;
  [[nodiscard]] bool any() const { return right != 0.0 || up != 0.0 || forward != 0.0; }
};

// Returns the speed [m/s] at a height above the ground: 30 m/s at the ground, growing linearly with the height, so that
// a flight around the planet in orbit takes minutes.
[[nodiscard]] double flight_speed(double height_m, bool fast);

// Returns the camera after `seconds` at `speed` [m/s].
[[nodiscard]] CameraState moved(const CameraState& camera, const Motion& motion, double seconds, double speed,
                                double radius_m);
// Returns the camera at least kMinHeight_m above ground of this elevation, and at most kMaxAltitude_m above sea level.
[[nodiscard]] CameraState above_ground(const CameraState& camera, double ground_m, double radius_m);
// Returns the camera turned by a drag in pixels, in a window of this height: the point under the pointer stays there.
[[nodiscard]] CameraState turned(const CameraState& camera, double dx_px, double dy_px, double height_px);
// Returns the camera zoomed by notches of the wheel; positive notches, away from the user, narrow the field of view.
[[nodiscard]] CameraState zoomed(const CameraState& camera, double notches);
// Returns the sun after a drag. A drag to the right turns it clockwise as seen from above; a drag upwards raises it.
[[nodiscard]] scene::SunParams sun_turned(const scene::SunParams& sun, double dx_px, double dy_px, double height_px);

}  // namespace tyndall::viewer
