// Functions that the positions of the sun and of the moon share: the nutation of the Earth's axis, the rotation of the
// Earth, and the parallax of a place on it. They follow Reda and Andreas (2003) and name its sections; see
// solar_position.hpp.
#pragma once

#include "math/angles.hpp"
#include "scene/description/solar_position.hpp"

namespace tyndall::scene {

constexpr double kSecondsPerDay = 86400.0;
constexpr double kDegreesPerArcsecond = 1.0 / 3600.0;

// A time in the two scales of astronomy.
struct Epoch {
  double days = 0.0;       // since J2000, universal time
  double centuries = 0.0;  // since J2000, terrestrial time
};
[[nodiscard]] Epoch epoch(double julian_day);

// Returns an angle in [0; 360).
[[nodiscard]] double wrapped_degrees(double angle_deg);

// Nutation in longitude and obliquity [deg]: the four largest terms (Meeus, "Astronomical Algorithms", 1998, chapter
// 22), which are within 0.5 arcseconds of the whole series.
struct Nutation {
  double longitude_deg = 0.0, obliquity_deg = 0.0;
};
[[nodiscard]] Nutation nutation(double centuries);
// Returns the inclination of the ecliptic of the date, with nutation.
[[nodiscard]] double obliquity_deg(double centuries, const Nutation& nutated);

// A position on the sky of the Earth's centre, for the equator and equinox of the date [rad].
struct Equatorial {
  double right_ascension_rad = 0.0, declination_rad = 0.0;
};
// Converts ecliptic longitude and latitude (3.8).
[[nodiscard]] Equatorial equatorial(double longitude_rad, double latitude_rad, double obliquity_rad);

struct Horizontal {
  double elevation_deg = 0.0, azimuth_deg = 0.0;
};
// Returns the position at a place, with parallax and without refraction. `sine_of_parallax`: the Earth's equatorial
// radius over the distance of the object.
[[nodiscard]] Horizontal horizontal(const Place& place, double altitude_m, const Epoch& time, const Nutation& nutated,
                                    double obliquity_rad, const Equatorial& position, double sine_of_parallax);

}  // namespace tyndall::scene
