#include "scene/description/lunar_position.hpp"

#include <cmath>
#include <cstddef>

#include "scene/description/celestial.hpp"

namespace tyndall::scene {
namespace {

// Multiples of the arguments D, M, M' and F, and amplitudes: of the longitude [1e-6 deg] and of the distance [m].
struct LongitudeTerm {
  int d, m, m1, f;
  double longitude, distance;
};
constexpr LongitudeTerm kLongitude[] = {
    {0, 0, 1, 0, 6288774, -20905355}, {2, 0, -1, 0, 1274027, -3699111}, {2, 0, 0, 0, 658314, -2955968},
    {0, 0, 2, 0, 213618, -569925},    {0, 1, 0, 0, -185116, 48888},     {0, 0, 0, 2, -114332, -3149},
    {2, 0, -2, 0, 58793, 246158},     {2, -1, -1, 0, 57066, -152138},   {2, 0, 1, 0, 53322, -170733},
    {2, -1, 0, 0, 45758, -204586},    {0, 1, -1, 0, -40923, -129620},   {1, 0, 0, 0, -34720, 108743},
    {0, 1, 1, 0, -30383, 104755},     {2, 0, 0, -2, 15327, 10321},      {0, 0, 1, 2, -12528, 0},
    {0, 0, 1, -2, 10980, 79661},      {4, 0, -1, 0, 10675, -34782},     {0, 0, 3, 0, 10034, -23210},
    {4, 0, -2, 0, 8548, -21636},      {2, 1, -1, 0, -7888, 24208},      {2, 1, 0, 0, -6766, 30824},
    {1, 0, -1, 0, -5163, -8379},      {1, 1, 0, 0, 4987, -16675},       {2, -1, 1, 0, 4036, -12831},
    {2, 0, 2, 0, 3994, -10445},       {4, 0, 0, 0, 3861, -11650},       {2, 0, -3, 0, 3665, 14403},
};

// A term of the latitude [1e-6 deg].
struct LatitudeTerm {
  int d, m, m1, f;
  double latitude;
};
constexpr LatitudeTerm kLatitude[] = {
    {0, 0, 0, 1, 5128122}, {0, 0, 1, 1, 280602}, {0, 0, 1, -1, 277693}, {2, 0, 0, -1, 173237}, {2, 0, -1, 1, 55413},
    {2, 0, -1, -1, 46271}, {2, 0, 0, 1, 32573},  {0, 0, 2, 1, 17198},   {2, 0, 1, -1, 9266},   {0, 0, 2, -1, 8822},
    {2, -1, 0, -1, 8216},  {2, 0, -2, -1, 4324}, {2, 0, 1, 1, 4200},
};

double sine(double degrees) { return std::sin(kRadPerDeg * degrees); }

}  // namespace

LunarPosition lunar_position(const Place& place, double julian_day) {
  const Epoch time = epoch(julian_day);
  const double t = time.centuries;
  // Mean longitude, elongation, anomaly of the sun, anomaly of the moon, argument of latitude [deg].
  const double mean = 218.3164477 + t * (481267.88123421 - 0.0015786 * t);
  const double d = 297.8501921 + t * (445267.1114034 - 0.0018819 * t);
  const double m = 357.5291092 + t * (35999.0502909 - 0.0001536 * t);
  const double m1 = 134.9633964 + t * (477198.8675055 + 0.0087414 * t);
  const double f = 93.2720950 + t * (483202.0175233 - 0.0036539 * t);
  // The eccentricity of the Earth's orbit decreases.
  const double eccentricity = 1.0 - t * (0.002516 + 0.0000074 * t);
  const auto weight = [&](int multiple) { return multiple == 0 ? 1.0 : eccentricity; };

  double longitude =
      3958.0 * sine(119.75 + 131.849 * t) + 1962.0 * sine(mean - f) + 318.0 * sine(53.09 + 479264.29 * t);
  double distance = 0.0;
  for (const LongitudeTerm& term : kLongitude) {
    const double angle = term.d * d + term.m * m + term.m1 * m1 + term.f * f;
    longitude += weight(term.m) * term.longitude * sine(angle);
    distance += weight(term.m) * term.distance * std::cos(kRadPerDeg * angle);
  }
  double latitude = -2235.0 * sine(mean) + 382.0 * sine(313.45 + 481266.484 * t);
  for (const LatitudeTerm& term : kLatitude) {
    latitude += weight(term.m) * term.latitude * sine(term.d * d + term.m * m + term.m1 * m1 + term.f * f);
  }

  const Nutation nutated = nutation(t);
  const double obliquity = kRadPerDeg * obliquity_deg(t, nutated);
  const double lambda = kRadPerDeg * (mean + 1e-6 * longitude + nutated.longitude_deg);
  const Equatorial position = equatorial(lambda, kRadPerDeg * 1e-6 * latitude, obliquity);
  LunarPosition out;
  out.right_ascension_deg = wrapped_degrees(position.right_ascension_rad / kRadPerDeg);
  out.declination_deg = position.declination_rad / kRadPerDeg;
  out.distance_km = 385000.56 + 1e-3 * distance;
  constexpr double kEarthRadius_km = 6378.14, kMoonRadius_km = 1737.4;
  const double parallax = kEarthRadius_km / out.distance_km;
  const Horizontal seen = horizontal(place, 0.0, time, nutated, obliquity, position, parallax);
  out.elevation_deg = seen.elevation_deg;
  out.azimuth_deg = seen.azimuth_deg;
  const double nearer_km = kEarthRadius_km * std::sin(kRadPerDeg * out.elevation_deg);
  out.angular_radius_deg = std::asin(kMoonRadius_km / (out.distance_km - nearer_km)) / kRadPerDeg;

  // The phase angle follows from the elongation from the sun (Meeus, chapter 48).
  const SolarPosition sun = solar_position(place, julian_day);
  const double between = kRadPerDeg * (sun.right_ascension_deg - out.right_ascension_deg);
  const double delta = kRadPerDeg * sun.declination_deg;
  const double cosine = std::sin(delta) * std::sin(position.declination_rad) +
                        std::cos(delta) * std::cos(position.declination_rad) * std::cos(between);
  const double elongation = std::acos(std::fmax(-1.0, std::fmin(1.0, cosine)));
  const double sun_km = 149597870.7 * sun.distance_au;
  out.phase_angle_deg =
      std::atan2(sun_km * std::sin(elongation), out.distance_km - sun_km * std::cos(elongation)) / kRadPerDeg;
  return out;
}

double moon_illuminance(double phase_angle_deg) {
  constexpr double kLuxPerFootcandle = 10.763910;
  const double a = std::abs(phase_angle_deg);
  const double magnitude = 3.84 + 0.026 * a + 4e-9 * a * a * a * a;
  // The paper recommends a factor for the opposition effect at small angles.
  const double opposition = a < 7.0 ? 1.35 - 0.05 * a : 1.0;
  return kLuxPerFootcandle * opposition * std::pow(10.0, -0.4 * magnitude);
}

double moon_illuminance(double phase_angle_deg, double angular_radius_deg) {
  constexpr double kMeanRadius_deg = 0.2591;  // at the mean distance
  const double nearer = angular_radius_deg / kMeanRadius_deg;
  return moon_illuminance(phase_angle_deg) * nearer * nearer;
}

}  // namespace tyndall::scene
