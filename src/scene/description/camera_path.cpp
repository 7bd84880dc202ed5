#include "scene/description/camera_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/description/lunar_position.hpp"
#include "scene/description/map_projection.hpp"
#include "scene/description/placed_sun.hpp"

namespace tyndall::scene {
namespace {

constexpr double kAltitudeScale_m = 1000.0;

// Values at increasing times. In a loop of period_s the last knot is one period after the first.
struct Knots {
  std::vector<double> times_s, values;
};

double square(double x) { return x * x; }

// Returns the slope at the middle of three knots: the weighted harmonic mean of Fritsch and Butland ("A method for
// constructing local monotone piecewise cubic interpolants", 1984), 0 at an extremum. The curve never leaves the range
// of its knots.
double monotone_slope(double h0, double d0, double h1, double d1) {
  if (d0 * d1 <= 0.0) return 0.0;
  const double w0 = 2.0 * h1 + h0;
  const double w1 = h1 + 2.0 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

// Returns the slope at the middle of three knots of a curve in space: that of the parabola through them.
double parabola_slope(double h0, double d0, double h1, double d1) { return (h1 * d0 + h0 * d1) / (h0 + h1); }

// Evaluates a cubic Hermite curve at time t. With `loop`, the knots repeat, and each repetition adds last - first to
// the values.
double interpolate(const Knots& knots, double t, bool loop, double (*slope_of)(double, double, double, double)) {
  const std::vector<double>& x = knots.times_s;
  const std::vector<double>& y = knots.values;
  const std::size_t last = x.size() - 1;
  if (last == 0 || t <= x.front()) return y.front();
  if (t >= x.back()) return y.back();
  const std::size_t i = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), t) - x.begin()) - 1;
  const auto step = [&](std::size_t k) { return x[k + 1] - x[k]; };
  const auto rise = [&](std::size_t k) { return (y[k + 1] - y[k]) / step(k); };
  const auto slope = [&](std::size_t k) {
    if (k > 0 && k < last) return slope_of(step(k - 1), rise(k - 1), step(k), rise(k));
    if (loop) return slope_of(step(last - 1), rise(last - 1), step(0), rise(0));
    return 0.0;  // the flight begins and ends at rest
  };
  const double h = step(i);
  const double u = (t - x[i]) / h;
  return y[i] * (1.0 + 2.0 * u) * square(1.0 - u) + h * slope(i) * u * square(1.0 - u) +
         y[i + 1] * square(u) * (3.0 - 2.0 * u) - h * slope(i + 1) * square(u) * (1.0 - u);
}

// Returns a knot for each frame for which `get` returns a number.
template <typename Get>
Knots knots_of(const CameraPath& path, Get get) {
  Knots out;
  for (const PathFrame& frame : path.frames) {
    if (const std::optional<double> value = get(frame)) {
      out.times_s.push_back(frame.time_s);
      out.values.push_back(*value);
    }
  }
  if (path.loop && !out.values.empty()) {
    out.times_s.push_back(out.times_s.front() + path.duration_s() - path.frames.front().time_s);
    out.values.push_back(out.values.front());
  }
  return out;
}

std::optional<double> wide(const std::optional<float>& value) {
  return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
}

// Adds full turns to each angle, so that it differs from the previous angle by at most half a turn.
void unwrap(std::vector<double>& angles_deg) {
  for (std::size_t i = 1; i < angles_deg.size(); ++i) {
    angles_deg[i] += 360.0 * std::round((angles_deg[i - 1] - angles_deg[i]) / 360.0);
  }
}

// Returns a time on the path. In a loop, it is wrapped to the period that starts at the first knot.
double time_in(const Knots& knots, double seconds, const CameraPath& path) {
  if (!path.loop) return seconds;
  const double first = knots.times_s.front();
  const double period = knots.times_s.back() - first;
  return first + (seconds - first) - period * std::floor((seconds - first) / period);
}

class Pose {
 public:
  Pose(const CameraPath& path, double seconds) : path_(path), seconds_(seconds) {}

  template <typename Get>
  [[nodiscard]] std::optional<double> value(Get get, bool angle = false,
                                            double (*slope)(double, double, double, double) = monotone_slope) const {
    Knots knots = knots_of(path_, get);
    if (knots.values.empty()) return std::nullopt;
    if (angle) unwrap(knots.values);
    return interpolate(knots, time_in(knots, seconds_, path_), path_.loop, slope);
  }
  [[nodiscard]] std::optional<double> value(std::optional<float> PathFrame::*member, bool angle = false) const {
    return value([&](const PathFrame& frame) { return wide(frame.*member); }, angle);
  }

 private:
  const CameraPath& path_;
  double seconds_;
};

void set(float& target, const std::optional<double>& value) {
  if (value) target = static_cast<float>(*value);
}

// Sets `target` to the value, wrapped to [0; 360), if there is one.
void set_angle(float& target, const std::optional<double>& value_deg) {
  if (value_deg) target = static_cast<float>(*value_deg - 360.0 * std::floor(*value_deg / 360.0));
}

// Interpolates the position of the camera: the direction from the planet's centre as a curve in space, and the
// altitude.
void move(CameraParams& camera, const Pose& pose, double radius_m) {
  const glm::dvec3 at = to_glm(camera.position_m);
  glm::dvec3 up = up_of(at, radius_m);
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<double> part = pose.value(
        [&](const PathFrame& frame) -> std::optional<double> {
          if (!frame.position_m) return std::nullopt;
          return up_of(to_glm(*frame.position_m), radius_m)[axis];
        },
        false, parabola_slope);
    if (part) up[axis] = *part;
  }
  const std::optional<double> scaled = pose.value([&](const PathFrame& frame) -> std::optional<double> {
    if (frame.altitude_m) return std::asinh(static_cast<double>(*frame.altitude_m) / kAltitudeScale_m);
    if (frame.position_m) return std::asinh(altitude_of(to_glm(*frame.position_m), radius_m) / kAltitudeScale_m);
    return std::nullopt;
  });
  double altitude = altitude_of(at, radius_m);
  if (camera.altitude_m >= 0.0F) altitude = static_cast<double>(camera.altitude_m);
  if (scaled) altitude = kAltitudeScale_m * std::sinh(*scaled);
  const glm::dvec3 place = at_altitude(glm::dvec3(0.0, -radius_m, 0.0) + up * radius_m, altitude, radius_m);
  camera.position_m = {place.x, place.y, place.z};
  camera.altitude_m = -1.0F;
}

}  // namespace

bool CameraPath::has_dates() const {
  return std::any_of(frames.begin(), frames.end(), [](const PathFrame& frame) { return frame.julian_day.has_value(); });
}

bool CameraPath::moves_sun() const {
  return std::any_of(frames.begin(), frames.end(), [](const PathFrame& frame) {
    return frame.julian_day || frame.sun_elevation_deg || frame.sun_azimuth_deg;
  });
}

double CameraPath::duration_s() const { return frames.empty() ? 0.0 : frames.back().time_s; }

SceneParams pose_at(const CameraPath& path, double seconds, const SceneParams& base, double radius_m) {
  SceneParams out = base;
  if (path.empty()) return out;
  const Pose pose(path, seconds);
  const bool moves = std::any_of(path.frames.begin(), path.frames.end(),
                                 [](const PathFrame& frame) { return frame.position_m || frame.altitude_m; });
  if (moves) move(out.camera, pose, radius_m);
  set_angle(out.camera.yaw_deg, pose.value(&PathFrame::yaw_deg, true));
  set(out.camera.pitch_deg, pose.value(&PathFrame::pitch_deg));
  set(out.camera.fov_deg, pose.value(&PathFrame::fov_deg));
  std::optional<double> elevation = pose.value(&PathFrame::sun_elevation_deg);
  std::optional<double> azimuth = pose.value(&PathFrame::sun_azimuth_deg, true);
  if (const std::optional<double> day = pose.value([](const PathFrame& frame) { return frame.julian_day; })) {
    const SolarPosition sun = solar_position(path.place, *day);
    elevation = sun.elevation_deg;
    azimuth = sun.azimuth_deg;
    if (base.moon.by_date) {
      const LunarPosition moon = lunar_position(path.place, *day);
      const double raised_deg = base.sun.refraction ? refraction_deg(moon.elevation_deg) : 0.0;
      out.moon.elevation_deg = static_cast<float>(moon.elevation_deg + raised_deg);
      out.moon.azimuth_deg = static_cast<float>(moon.azimuth_deg);
      out.moon.angular_radius_deg = static_cast<float>(moon.angular_radius_deg);
      out.moon.by_date = false;
    }
  }
  set(out.sun.elevation_deg, elevation);
  set_angle(out.sun.azimuth_deg, azimuth);
  if (elevation || azimuth) {
    out.sun.animate = false;
    out.sun.time.clear();
  }
  return out;
}

}  // namespace tyndall::scene
