// Numerical integration for the tests of the path tracer: the same spherical-shell atmosphere, implemented from the
// definitions alone, without a table, a closed form or any code of src/reference.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tyndall/params.hpp"

namespace oracle {

constexpr double kPi = std::numbers::pi;

struct Point {
  double x, y, z;
};
inline Point along(const Point& p, const Point& w, double t) { return {p.x + w.x * t, p.y + w.y * t, p.z + w.z * t}; }
inline double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Integrates by an eight-point Gauss-Legendre rule over each of `panels` equal parts of [a; b].
template <typename F>
void integrate(double a, double b, int panels, F&& add) {
  constexpr std::array<double, 4> kNode = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                           0.9602898564975363};
  constexpr std::array<double, 4> kWeight = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                             0.1012285362903763};
  const double half = 0.5 * (b - a) / panels;
  for (int i = 0; i < panels; ++i) {
    const double middle = a + (2 * i + 1) * half;
    for (int k = 7; k >= 0; --k) {  // in ascending order
      const int j = k > 3 ? k - 4 : 3 - k;
      const double node = k > 3 ? -kNode[static_cast<std::size_t>(j)] : kNode[static_cast<std::size_t>(j)];
      add(middle + half * node, half * kWeight[static_cast<std::size_t>(j)]);
    }
  }
}

inline double rayleigh_phase(double c) { return 0.75 * (1.0 + c * c) / (4.0 * kPi); }

// The atmosphere of given Params. Functions take the coefficients of one channel.
struct Air {
  double radius, top, rayleigh_height, mie_height;
  double rayleigh, mie_scattering, mie_extinction, ozone, ozone_centre, ozone_half_width;
  double g;
  bool cornette_shanks;

  [[nodiscard]] double rayleigh_at(double h) const { return rayleigh * std::exp(-h / rayleigh_height); }
  [[nodiscard]] double mie_at(double h) const { return std::exp(-h / mie_height); }
  [[nodiscard]] double extinction_at(double h) const {
    const double tent = std::max(0.0, 1.0 - std::abs(h - ozone_centre) / ozone_half_width);
    return rayleigh_at(h) + mie_extinction * mie_at(h) + ozone * tent;
  }
  [[nodiscard]] double height(const Point& p) const { return std::sqrt(dot(p, p)) - radius; }
  [[nodiscard]] double mie_phase(double c) const {
    const double hg = (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * c, 1.5));
    return cornette_shanks ? hg * 1.5 * (1.0 + c * c) / (2.0 + g * g) : hg;
  }

  // Returns the distance to the ground, a sphere of radius `solid`, or to the top; `ground` is set accordingly.
  [[nodiscard]] double reach(const Point& p, const Point& w, bool& ground, double solid) const {
    const double b = dot(p, w), c2 = dot(p, p);
    const double hit = b * b - c2 + solid * solid;
    ground = b < 0.0 && hit > 0.0;
    return ground ? std::max(0.0, -b - std::sqrt(hit)) : -b + std::sqrt(b * b - c2 + top * top);
  }
  [[nodiscard]] double depth(const Point& p, const Point& w, double length, int panels) const {
    double sum = 0.0;
    integrate(0.0, length, panels, [&](double t, double dt) { sum += dt * extinction_at(height(along(p, w, t))); });
    return sum;
  }
  // Returns the transmittance to the sun, 0 in the planet's shadow.
  [[nodiscard]] double sun_transmittance(const Point& p, const Point& sun, int panels) const {
    bool ground = false;
    const double length = reach(p, sun, ground, radius);
    return ground ? 0.0 : std::exp(-depth(p, sun, length, panels));
  }
};

inline Air air_of(const tyndall::Params& p, double rayleigh, double mie_scattering, double mie_extinction,
                  double ozone) {
  const tyndall::AtmosphereParams& a = p.atmosphere;
  return {p.planet.radius_m,
          static_cast<double>(p.planet.radius_m) + a.height_m,
          a.rayleigh_scale_height_m,
          a.mie_scale_height_m,
          rayleigh,
          mie_scattering,
          mie_extinction,
          ozone,
          a.ozone_centre_m,
          a.ozone_half_width_m,
          a.mie_g,
          a.mie_phase == tyndall::MiePhase::cornette_shanks};
}

// Returns the radius of the ground that a camera ray can hit: sea level or, from below it, the sphere at twice the
// depth.
inline double camera_ground(const Air& air, const Point& p) {
  return air.radius + 2.0 * std::min(0.0, std::sqrt(dot(p, p)) - air.radius);
}

// Returns single scattering along a ray from p, relative to the sun [1/sr]. Small panels resolve the edge of the
// shadow.
inline double single_scattering(const Air& air, const Point& p, const Point& w, const Point& sun, int panels,
                                int sun_panels) {
  bool ground = false;
  const double length = air.reach(p, w, ground, camera_ground(air, p));
  const double c = dot(w, sun);
  const double rayleigh = rayleigh_phase(c), mie = air.mie_phase(c);
  // t = length * u^2 concentrates the nodes near the eye. The optical depth is accumulated from node to node.
  double sum = 0.0, depth = 0.0, before = 0.0;
  integrate(0.0, 1.0, panels, [&](double u, double du) {
    const double t = length * u * u;
    depth += air.depth(along(p, w, before), w, t - before, 1);
    before = t;
    const Point q = along(p, w, t);
    const double lit = air.sun_transmittance(q, sun, sun_panels);
    if (lit <= 0.0) return;
    const double h = air.height(q);
    sum += 2.0 * length * u * du * std::exp(-depth) * lit *
           (air.rayleigh_at(h) * rayleigh + air.mie_scattering * air.mie_at(h) * mie);
  });
  return sum;
}

}  // namespace oracle
