// Where the sun stands, by place and time: the method of Reda and Andreas, "Solar Position Algorithm for
// Solar Radiation Applications" (NREL/TP-560-34302, 2003, revised 2008), with its series cut where they fall
// below 1e-6 of a radian. Against the whole series: within 0.0005 deg. Times are taken as UT1, from which UTC
// is never more than 0.9 s, or 0.004 deg, away. Pure functions, safe from any thread.
#pragma once

#include <string_view>

#include "tyndall/result.hpp"

namespace tyndall::scene {

struct Place {
  double latitude_deg = 0.0;   // geodetic, north positive, [-90; 90]
  double longitude_deg = 0.0;  // east positive, [-180; 180]
};

struct SolarPosition {
  // As a straight line from the place has it: parallax is included and refraction is not (it lifts the sun by
  // some 0.5 deg at the horizon, 0.1 deg at 10 deg).
  double elevation_deg = 0.0;  // above the horizontal
  double azimuth_deg = 0.0;    // clockwise from north, [0; 360)
  // From the centre of the Earth, apparent: of the equator and equinox of the date.
  double right_ascension_deg = 0.0;  // [0; 360)
  double declination_deg = 0.0;
  double distance_au = 1.0;
};

// `julian_day`: of 1900 to 2100, UT. `altitude_m`: of the place above sea level, enters by the parallax
// alone.
[[nodiscard]] SolarPosition solar_position(const Place& place, double julian_day, double altitude_m = 0.0);

// Terrestrial minus universal time in s: the polynomials of Espenak and Meeus, "Five Millennium Canon of
// Solar Eclipses" (NASA/TP-2006-214141), 1900 to 2150. `year` with its fraction.
[[nodiscard]] double delta_t_s(double year);

// "LAT,LON" in degrees. `where` names the source in errors.
[[nodiscard]] Result<Place> parse_place(std::string_view text, std::string_view where);

// A date and time of ISO 8601 in the extended form, with Z or an offset from UTC, of the years 1900 to 2100:
// "2003-10-17T12:30:30.5-07:00", "2003-10-17T19:30Z". The Julian day. `where` names the source in errors.
[[nodiscard]] Result<double> parse_time(std::string_view text, std::string_view where);

}  // namespace tyndall::scene
