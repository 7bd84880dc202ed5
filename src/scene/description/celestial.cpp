#include "scene/description/celestial.hpp"

#include <cmath>

namespace tyndall::scene {
namespace {

constexpr double kJ2000 = 2451545.0;  // Julian day of the epoch
constexpr double kDaysPerCentury = 36525.0;

}  // namespace

Epoch epoch(double julian_day) {
  const double days = julian_day - kJ2000;
  const double delta_t_days = delta_t_s(2000.0 + days / 365.25) / kSecondsPerDay;
  return {days, (days + delta_t_days) / kDaysPerCentury};
}

double wrapped_degrees(double angle_deg) {
  const double wrapped = std::fmod(angle_deg, 360.0);
  const double positive = wrapped < 0.0 ? wrapped + 360.0 : wrapped;
  return positive < 360.0 ? positive : 0.0;
}

Nutation nutation(double centuries) {
  const double node = (125.04452 - 1934.136261 * centuries) * kRadPerDeg;  // ascending node of the moon's orbit
  const double sun = (280.4665 + 36000.7698 * centuries) * kRadPerDeg;     // mean longitudes
  const double moon = (218.3165 + 481267.8813 * centuries) * kRadPerDeg;
  return {kDegreesPerArcsecond * (-17.20 * std::sin(node) - 1.32 * std::sin(2.0 * sun) - 0.23 * std::sin(2.0 * moon) +
                                  0.21 * std::sin(2.0 * node)),
          kDegreesPerArcsecond * (9.20 * std::cos(node) + 0.57 * std::cos(2.0 * sun) + 0.10 * std::cos(2.0 * moon) -
                                  0.09 * std::cos(2.0 * node))};
}

double obliquity_deg(double centuries, const Nutation& nutated) {
  return kDegreesPerArcsecond * (84381.448 + centuries * (-46.8150 + centuries * (-0.00059 + centuries * 0.001813))) +
         nutated.obliquity_deg;
}

Equatorial equatorial(double longitude_rad, double latitude_rad, double obliquity_rad) {
  const double lambda = longitude_rad;
  const double beta = latitude_rad;
  const double tilt = obliquity_rad;
  return {std::atan2(std::sin(lambda) * std::cos(tilt) - std::tan(beta) * std::sin(tilt), std::cos(lambda)),
          std::asin(std::sin(beta) * std::cos(tilt) + std::cos(beta) * std::sin(tilt) * std::sin(lambda))};
}

Horizontal horizontal(const Place& place, double altitude_m, const Epoch& time, const Nutation& nutated,
                      double obliquity_rad, const Equatorial& position, double sine_of_parallax) {
  // The rotation of the Earth (3.9 to 3.11).
  const double ut_centuries = time.days / kDaysPerCentury;
  const double sidereal_deg = 280.46061837 + 360.98564736629 * time.days +
                              ut_centuries * ut_centuries * (0.000387933 - ut_centuries / 38710000.0) +
                              nutated.longitude_deg * std::cos(obliquity_rad);
  const double hour_angle = kRadPerDeg * wrapped_degrees(sidereal_deg + place.longitude_deg -
                                                         wrapped_degrees(position.right_ascension_rad / kRadPerDeg));

  // Parallax (3.12). The distances of the place from the Earth's axis and equatorial plane are in equatorial radii.
  constexpr double kAxes = 0.99664719;  // polar radius divided by equatorial radius
  const double delta = position.declination_rad;
  const double phi = kRadPerDeg * place.latitude_deg;
  const double reduced = std::atan2(kAxes * std::sin(phi), std::cos(phi));
  const double radii = altitude_m / 6378140.0;
  const double from_axis = std::cos(reduced) + radii * std::cos(phi);
  const double from_equator = kAxes * std::sin(reduced) + radii * std::sin(phi);
  // The direction: x is towards the point where the celestial equator crosses the meridian, y is west, and z is towards
  // the celestial pole.
  const double x = std::cos(delta) * std::cos(hour_angle) - sine_of_parallax * from_axis;
  const double y = std::cos(delta) * std::sin(hour_angle);
  const double z = std::sin(delta) - sine_of_parallax * from_equator;
  const double up = std::sin(phi) * z + std::cos(phi) * x;
  const double north = std::cos(phi) * z - std::sin(phi) * x;
  return {std::atan2(up, std::hypot(north, y)) / kRadPerDeg, wrapped_degrees(std::atan2(-y, north) / kRadPerDeg)};
}

}  // namespace tyndall::scene
