// The position, the phase and the illuminance of the moon by place and time. The position follows Meeus, "Astronomical
// Algorithms" (1998), chapter 47, with the terms above 0.003 degrees: it is within 0.02 degrees of the whole series.
// Pure functions, safe from any thread.
#pragma once

#include "scene/description/solar_position.hpp"

namespace tyndall::scene {

struct LunarPosition {
  double elevation_deg = 0.0;  // with parallax, which is up to 1 degree, and without refraction
  double azimuth_deg = 0.0;    // clockwise from north, [0; 360)
  // Apparent position as seen from the centre of the Earth, for the equator and equinox of the date.
  double right_ascension_deg = 0.0;
  double declination_deg = 0.0;
  double distance_km = 384400.0;      // between the centres of the Earth and the moon
  double angular_radius_deg = 0.259;  // as seen from the place
  double phase_angle_deg = 0.0;       // between the directions from the moon to the sun and to the Earth; 0: full moon
};

// Returns the position of the moon. `julian_day` is in UT, from 1900 to 2100.
[[nodiscard]] LunarPosition lunar_position(const Place& place, double julian_day);

// Returns the illuminance of moonlight above the atmosphere, on a surface that faces it [lux]: Krisciunas and Schaefer,
// "A model of the brightness of moonlight" (1991), equation 20, which includes the opposition effect below 7 degrees,
// for the mean distance.
[[nodiscard]] double moon_illuminance(double phase_angle_deg);
// Returns the same for the distance at which the moon has this size.
[[nodiscard]] double moon_illuminance(double phase_angle_deg, double angular_radius_deg);

}  // namespace tyndall::scene
