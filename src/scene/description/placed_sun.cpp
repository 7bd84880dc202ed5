#include "scene/description/placed_sun.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "files/text.hpp"

namespace tyndall::scene {

double refraction_deg(double elevation_deg) {
  constexpr double kRadPerDeg = std::numbers::pi / 180.0;
  constexpr double kLowest_deg = -5.0;  // the formula has a pole at -5.11
  const double h = std::max(elevation_deg, -1.0);
  const double arcmin = 1.02 / std::tan((h + 10.3 / (h + 5.11)) * kRadPerDeg) + 0.0019279;
  const double fade = std::clamp((elevation_deg - kLowest_deg) / (-1.0 - kLowest_deg), 0.0, 1.0);
  return std::max(arcmin, 0.0) / 60.0 * fade;
}

Result<SunParams> placed_sun(const SunParams& sun, const std::optional<Place>& terrain_place) {
  SunParams out = sun;
  double elevation_deg = sun.elevation_deg;
  if (!sun.time.empty()) {
    const Result<double> day = parse_time(sun.time, "sun.time");
    if (!day) return day.error();
    std::optional<Place> place = terrain_place;
    if (!sun.place.empty()) {
      const Result<Place> given = parse_place(sun.place, "sun.place");
      if (!given) return given.error();
      place = given.value();
    }
    if (!place) {
      return files::input_error("the time of the sun has no place", "sun.time",
                                "expected sun.place = \"LAT,LON\", or an elevation file with a coordinate system");
    }
    const SolarPosition position = solar_position(*place, day.value());
    elevation_deg = position.elevation_deg;
    out.azimuth_deg = static_cast<float>(position.azimuth_deg);
  }
  if (sun.refraction) elevation_deg += refraction_deg(elevation_deg);
  if (!sun.time.empty() || sun.refraction) out.elevation_deg = static_cast<float>(elevation_deg);
  return out;
}

}  // namespace tyndall::scene
