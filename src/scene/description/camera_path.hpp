// A camera path with the time of day: keyframes, and the parameters of the scene at any time of the path. Pure
// functions, used alike for pictures in files and in the window.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/description/scene_params.hpp"
#include "scene/description/solar_position.hpp"

namespace tyndall::scene {

// A keyframe. A missing value is interpolated between other keyframes. If no keyframe has it, the parameter is used.
struct PathFrame {
  double time_s = 0.0;
  std::optional<DVec3> position_m;
  std::optional<float> altitude_m;  // above sea level, >= 0; replaces the altitude of position_m
  std::optional<float> yaw_deg, pitch_deg, fov_deg;
  std::optional<float> sun_elevation_deg, sun_azimuth_deg;
  // ISO 8601 with the offset from UTC; empty: not given. The sun's position follows from it and CameraPath::place.
  std::string date;
  std::optional<double> julian_day;  // the Julian day of `date`
};

struct CameraPath {
  std::vector<PathFrame> frames;  // in the order of time; none, or at least two
  bool loop = false;              // the last frame is equal to the first and has only a time
  std::string place_text;         // "LAT,LON"; empty: the place of the elevation file, see Scene::place()
  Place place;

  [[nodiscard]] bool empty() const { return frames.empty(); }
  [[nodiscard]] bool has_dates() const;     // returns whether the sun's position follows from dates and the place
  [[nodiscard]] bool moves_sun() const;     // returns whether it follows from dates, or from angles of keyframes
  [[nodiscard]] double duration_s() const;  // returns the time of the last frame
};

// Returns `base` with the camera and the sun as they are `seconds` into the path. All quantities and their first
// derivatives are continuous and never overshoot the keyframes. Yaw and azimuth rotate the shorter way; positions
// follow the curvature of the planet; altitudes are interpolated in asinh(h/1 km), which is linear near the ground and
// logarithmic far above it. Before the first frame and after the last the pose is constant, unless the path loops. If
// the path moves the sun, sun.animate is off. With dates, the moon of moon.by_date moves as well.
[[nodiscard]] SceneParams pose_at(const CameraPath& path, double seconds, const SceneParams& base, double radius_m);

}  // namespace tyndall::scene
