// The position of the sun by place and time, after Reda and Andreas, "Solar Position Algorithm for Solar Radiation
// Applications" (NREL/TP-560-34302, 2003, revised 2008). The series are truncated where their terms fall below 1e-6
// rad, which changes the result by less than 0.0005 deg. Times are taken as UT1; UTC differs from it by at most 0.9 s,
// or 0.004 deg. Pure functions, safe from any thread.
#pragma once

#include <string_view>

#include "tyndall/result.hpp"

namespace tyndall::scene {

struct Place {
  double latitude_deg = 0.0;   // geodetic, north positive, [-90; 90]
  double longitude_deg = 0.0;  // east positive, [-180; 180]
};

struct SolarPosition {
  // The angles include parallax, but no refraction, which raises the sun by about 0.5 deg at the horizon and by 0.1 deg
  // at an elevation of 10 deg.
  double elevation_deg = 0.0;  // above the horizontal
  double azimuth_deg = 0.0;    // clockwise from north, [0; 360)
  // Apparent position as seen from the centre of the Earth, for the equator and equinox of the date.
  double right_ascension_deg = 0.0;  // [0; 360)
  double declination_deg = 0.0;
  double distance_au = 1.0;
};

// Returns the position of the sun. `julian_day` is in UT, from 1900 to 2100. `altitude_m` is the altitude of the place
// above sea level and affects only the parallax.
[[nodiscard]] SolarPosition solar_position(const Place& place, double julian_day, double altitude_m = 0.0);

// Returns terrestrial minus universal time [s] by the polynomials of Espenak and Meeus, "Five Millennium Canon of
// Solar Eclipses" (NASA/TP-2006-214141), 1900 to 2150. `year` includes the fraction.
[[nodiscard]] double delta_t_s(double year);

// Parses "LAT,LON" in degrees. Error messages name the source of the text, `where`.
[[nodiscard]] Result<Place> parse_place(std::string_view text, std::string_view where);

// Parses a date and time of ISO 8601 in the extended form, with Z or an offset from UTC, of the years 1900 to 2100,
// such as "2003-10-17T12:30:30.5-07:00" or "2003-10-17T19:30Z". Returns the Julian day. Error messages name `where`.
[[nodiscard]] Result<double> parse_time(std::string_view text, std::string_view where);

}  // namespace tyndall::scene
