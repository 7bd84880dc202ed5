// A flight of the camera with the time of day: keyframes, and the scene's parameters at any time of it. Pure functions,
// the same for pictures in files and in the window.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/description/scene_params.hpp"
#include "scene/description/solar_position.hpp"

namespace tyndall::scene {

// What a keyframe leaves out, the others decide; what all of them leave out is the parameters'.
struct PathFrame {
  double time_s = 0.0;
  std::optional<DVec3> position_m;
  std::optional<float> altitude_m;  // above sea level, >= 0; replaces that of position_m
  std::optional<float> yaw_deg, pitch_deg, fov_deg;
  std::optional<float> sun_elevation_deg, sun_azimuth_deg;
  std::string date;  // ISO 8601 with the offset from UTC; places the sun, with CameraPath::place; empty: not given
  std::optional<double> julian_day;  // of `date`
};

struct CameraPath {
  std::vector<PathFrame> frames;  // by rising time; none, or two and more
  bool loop = false;              // the last frame is the first again, and has nothing but its time
  std::string place_text;         // "LAT,LON"; empty: that of the elevation file, see Scene::place()
  Place place;

  [[nodiscard]] bool empty() const { return frames.empty(); }
  [[nodiscard]] bool has_dates() const;     // whether the sun stands by date and place
  [[nodiscard]] double duration_s() const;  // time of the last frame
};

// `base` with the camera and the sun as they are `seconds` into the path. All of them change continuously with their
// first derivatives and never overshoot keyframes; yaw and azimuth turn the short way round; places follow the curve of
// the planet; altitudes are interpolated by asinh(h/1 km), which is linear near the ground and logarithmic far above.
// Before the first frame and after the last the path stands still, unless it loops. Where the path moves the sun,
// sun.animate is off.
[[nodiscard]] SceneParams pose_at(const CameraPath& path, double seconds, const SceneParams& base, double radius_m);

}  // namespace tyndall::scene
