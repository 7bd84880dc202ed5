#include "validate/rays.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/angles.hpp"

namespace tyndall::validate {
namespace {

// SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

// Returns points in the cube [0; 1)^4 such that, in every coordinate, each of `count` equal parts contains one point
// (Latin hypercube, McKay, Beckman and Conover 1979).
std::vector<std::array<double, 4>> even_points(std::uint64_t seed, std::uint32_t count) {
  std::vector<std::array<double, 4>> points(count);
  std::uint64_t state = mixed(seed);
  const auto below = [&](std::uint64_t limit) { return (state = mixed(state)) % limit; };
  std::vector<std::uint32_t> order(count);
  for (std::size_t axis = 0; axis < 4; ++axis) {
    for (std::uint32_t i = 0; i < count; ++i) order[i] = i;
    for (std::uint32_t i = count; i > 1; --i) std::swap(order[i - 1], order[below(i)]);
    for (std::uint32_t i = 0; i < count; ++i) {
      const double within = static_cast<double>(mixed(state + i) >> 11U) * 0x1p-53;
      points[i][axis] = (order[i] + within) / count;
    }
  }
  return points;
}

// Sets the sun of a query, given the sun's direction at the point of the ray that is nearest to the ground: its
// elevation there, and its azimuth from the ray. `turn` is the angle at the planet's centre between the eye and that
// point. The zenith angle of the ray decreases by `turn` on the way from the eye to the point.
void set_sun(RayQuery& query, double turn, double sun_elevation_rad, double azimuth) {
  // Coordinates in which the ray lies in the plane z = 0: x along its azimuth, y up, z to the side.
  const double x = std::cos(sun_elevation_rad) * std::cos(azimuth);
  const double y = std::sin(sun_elevation_rad);
  const double side = std::cos(sun_elevation_rad) * std::sin(azimuth);
  // The eye's vertical lies `turn` behind that of the point.
  const double eye_x = x * std::cos(turn) + y * std::sin(turn);
  const double eye_y = y * std::cos(turn) - x * std::sin(turn);
  query.sun_zenith_rad = std::acos(std::clamp(eye_y, -1.0, 1.0));
  query.azimuth_rad = std::abs(std::atan2(side, eye_x));
}

}  // namespace

std::vector<TestRay> make_rays(Region region, SunBand band, std::uint32_t count, std::uint64_t seed, double radius_m,
                               double height_m) {
  std::vector<TestRay> rays;
  const std::uint64_t group =
      mixed(seed) + kSunBands * static_cast<std::uint64_t>(region) + static_cast<std::uint64_t>(band);
  const double scale = height_m / 80000.0;
  const std::vector<std::array<double, 4>> points = even_points(group, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::array<double, 4>& u = points[i];
    TestRay ray;
    ray.region = region;
    ray.band = band;
    ray.sun_elevation_rad = (band == SunBand::up ? 90.0 * u[0] : -6.0 * u[0]) * kRadPerDeg;
    const double azimuth = kPi * u[1];
    RayQuery& q = ray.query;
    if (region != Region::space) {
      q.altitude_m = scale * (region == Region::ground ? 2000.0 * u[2] * u[2] : 2000.0 + 68000.0 * u[2] * u[2]);
      q.view_zenith_rad = (region == Region::ground ? 90.0 : 180.0) * u[3] * kRadPerDeg;
      q.sun_zenith_rad = 0.5 * kPi - ray.sun_elevation_rad;
      q.azimuth_rad = azimuth;
    } else {
      q.altitude_m = scale * 100000.0 * std::pow(200.0, u[2]);
      const double r = radius_m + q.altitude_m;
      if (i % 2 == 0) {
        // Towards the ground, evenly in the nadir angle. `fall` is the ray's angle of incidence there.
        const double nadir = std::asin(radius_m / r) * u[3];
        const double fall = std::asin(std::min(r * std::sin(nadir) / radius_m, 1.0));
        q.view_zenith_rad = kPi - nadir;
        set_sun(q, fall - nadir, ray.sun_elevation_rad, azimuth);
      } else {
        const double tangent = radius_m + scale * 60000.0 * u[3];
        const double nadir = std::asin(tangent / r);
        q.view_zenith_rad = kPi - nadir;
        set_sun(q, 0.5 * kPi - nadir, ray.sun_elevation_rad, azimuth);
      }
    }
    rays.push_back(ray);
  }
  return rays;
}

std::vector<TestRay> make_horizon_rays(SunBand band, std::uint32_t count, std::uint64_t seed, double radius_m,
                                       double height_m) {
  constexpr std::uint64_t kSet = 1000;  // distinct from the groups of make_rays
  std::vector<TestRay> rays;
  const double scale = height_m / 80000.0;
  for (const std::array<double, 4>& u : even_points(mixed(seed) + kSet + static_cast<std::uint64_t>(band), count)) {
    TestRay ray;
    ray.band = band;
    ray.sun_elevation_rad = (band == SunBand::up ? 0.5 + 9.5 * u[0] : -6.0 * u[0]) * kRadPerDeg;
    RayQuery& q = ray.query;
    q.altitude_m = scale * (2.0 + 2998.0 * u[2] * u[2]);
    const double dip = std::acos(radius_m / (radius_m + q.altitude_m));
    q.view_zenith_rad = 0.5 * kPi + dip - (0.5 + 4.5 * u[3]) * kRadPerDeg;
    q.sun_zenith_rad = 0.5 * kPi - ray.sun_elevation_rad;
    q.azimuth_rad = kPi * u[1];
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace tyndall::validate
