#include "scene/description/placed_sun.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "files/text.hpp"
#include "math/angles.hpp"
#include "scene/description/lunar_position.hpp"
#include "tyndall/photometry.hpp"

namespace tyndall::scene {
namespace {

// Returns sun.place or, without it, the place of the terrain.
Result<Place> place_of(const SunParams& sun, const std::optional<Place>& terrain_place) {
  if (!sun.place.empty()) return parse_place(sun.place, "sun.place");
  if (terrain_place) return *terrain_place;
  return files::input_error("the time of the sun has no place", "sun.time",
                            "expected sun.place = \"LAT,LON\", or an elevation file with a coordinate system");
}

}  // namespace

double refraction_deg(double elevation_deg) {
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
    const Result<Place> place = place_of(sun, terrain_place);
    if (!place) return place.error();
    const SolarPosition position = solar_position(place.value(), day.value());
    elevation_deg = position.elevation_deg;
    out.azimuth_deg = static_cast<float>(position.azimuth_deg);
  }
  if (sun.refraction) elevation_deg += refraction_deg(elevation_deg);
  if (!sun.time.empty() || sun.refraction) out.elevation_deg = static_cast<float>(elevation_deg);
  return out;
}

double refraction_flattening(double seen_elevation_deg, double angular_radius_deg) {
  // Fixed-point iteration for the elevation without refraction; its slope is at most 0.3.
  double h = seen_elevation_deg;
  for (int i = 0; i < 30; ++i) h = seen_elevation_deg - refraction_deg(h);
  const double upper = h + angular_radius_deg;
  const double lower = h - angular_radius_deg;
  return 1.0 + (refraction_deg(upper) - refraction_deg(lower)) / (2.0 * angular_radius_deg);
}

Result<MoonParams> placed_moon(const MoonParams& moon, const SunParams& sun,
                               const std::optional<Place>& terrain_place) {
  MoonParams out = moon;
  if (!moon.by_date) return out;
  if (sun.time.empty()) {
    return files::input_error("the moon has no date", "moon.by_date", "expected sun.time and sun.place");
  }
  const Result<double> day = parse_time(sun.time, "sun.time");
  if (!day) return day.error();
  const Result<Place> place = place_of(sun, terrain_place);
  if (!place) return place.error();
  const LunarPosition position = lunar_position(place.value(), day.value());
  const double raised = sun.refraction ? refraction_deg(position.elevation_deg) : 0.0;
  out.elevation_deg = static_cast<float>(position.elevation_deg + raised);
  out.azimuth_deg = static_cast<float>(position.azimuth_deg);
  out.angular_radius_deg = static_cast<float>(position.angular_radius_deg);
  return out;
}

double moon_irradiance_ratio(const MoonParams& placed, double cos_sun_moon) {
  constexpr double kDegPerRad = 180.0 / std::numbers::pi;
  // The sun is so far away that the phase angle and the elongation add up to half a turn.
  const double phase_deg = 180.0 - std::acos(std::clamp(cos_sun_moon, -1.0, 1.0)) * kDegPerRad;
  return moon_illuminance(phase_deg, static_cast<double>(placed.angular_radius_deg)) / kSunIlluminance_lux;
}

}  // namespace tyndall::scene
