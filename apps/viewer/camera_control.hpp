// How the hands move the camera and the sun: pure functions of the state before. Angles in deg, lengths in m.
// The camera flies over a curved planet: "up" is away from the planet's centre wherever it is, and its direction is
// carried along the way, so that nothing jumps from the ground to orbit.
#pragma once

#include <glm/glm.hpp>

#include "scene/description/scene_params.hpp"

namespace tyndall::viewer {

constexpr double kLeastHeight_m = 2.5;  // of the camera above the ground
constexpr double kHighest_m = 5.0e7;    // above sea level
constexpr double kSteepest_deg = 89.9;  // view up or down
constexpr double kFovRange_deg[2] = {2.0, 150.0};

// A camera in double precision: steps of centimetres count in orbit too.
struct CameraState {
  glm::dvec3 position = {};  // world [m]
  double yaw_deg = 0.0;      // as in CameraParams: to the local horizontal and north
  double pitch_deg = 0.0;
  double fov_deg = 45.0;
};

[[nodiscard]] CameraState camera_from_params(const scene::CameraParams& params, double radius_m);
// Writes position, direction and field of view; altitude_m becomes -1, "as position_m has it".
void camera_to_params(const CameraState& camera, scene::CameraParams& params);

// What the keys ask for, each -1 to 1 along the camera's right, the local up, and the direction of view.
struct Motion {
  double right = 0.0, up = 0.0, forward = 0.0;
  bool fast = false;
  [[nodiscard]] bool any() const { return right != 0.0 || up != 0.0 || forward != 0.0; }
};

// Speed at a height above the ground [m/s]: walking pace of a giant at the ground, planets in orbit.
[[nodiscard]] double flight_speed(double height_m, bool fast);

// The camera after `seconds` at `speed` [m/s].
[[nodiscard]] CameraState moved(const CameraState& camera, const Motion& motion, double seconds, double speed,
                                double radius_m);
// Lifted to kLeastHeight_m above ground of this elevation, and kept below kHighest_m.
[[nodiscard]] CameraState above_ground(const CameraState& camera, double ground_m, double radius_m);
// Turned by a drag in pixels of a window so many pixels high: what is under the pointer stays there.
[[nodiscard]] CameraState turned(const CameraState& camera, double dx_px, double dy_px, double height_px);
// Notches of the wheel, away from the hand positive: nearer.
[[nodiscard]] CameraState zoomed(const CameraState& camera, double notches);
// The sun after such a drag: right turns it clockwise seen from above, up lifts it.
[[nodiscard]] scene::SunParams sun_turned(const scene::SunParams& sun, double dx_px, double dy_px, double height_px);

}  // namespace tyndall::viewer
