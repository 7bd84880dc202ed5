// An independent implementation of the physics without shaders/lib: positions as vectors in double precision, its own
// densities, adaptive Gauss-Kronrod quadrature. It is the reference for the tests of shaders/lib.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "effect/shared.hpp"

namespace tyndall::brute {

using Three = std::array<double, 3>;

inline Three of(const Vec3& v) { return {v.x, v.y, v.z}; }

struct Point {
  double x = 0.0, y = 0.0, z = 0.0;  // from the planet's centre
};

inline Point along(const Point& p, const Point& direction, double d) {
  return {p.x + d * direction.x, p.y + d * direction.y, p.z + d * direction.z};
}
inline double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Integrates a three-component function over [a, b] to a relative tolerance of its largest component.
template <typename Function>
Three integrate(const Function& f, double a, double b, double tolerance, double floor = 0.0, int depth = 0) {
  static constexpr double kNodes[8] = {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                       0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                       0.586087235467691130294144691693013, 0.405845151377397166906606412076961,
                                       0.207784955007898467600689403773245, 0.0};
  static constexpr double kKronrod[8] = {0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                         0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                         0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                         0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
  static constexpr double kGauss[4] = {0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
                                       0.381830050505118944950369775488975, 0.417959183673469387755102040816327};
  const double middle = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  Three kronrod = {};
  Three gauss = {};
  for (int i = 0; i < 8; ++i) {
    for (int side = 0; side < (i == 7 ? 1 : 2); ++side) {
      const Three value = f(middle + (side == 0 ? -1.0 : 1.0) * half * kNodes[i]);
      for (int c = 0; c < 3; ++c) {
        kronrod[c] += half * kKronrod[i] * value[c];
        if (i % 2 == 1) {
          gauss[c] += half * kGauss[i / 2] * value[c];
        }
      }
    }
  }
  double size = floor;
  double error = 0.0;
  for (int c = 0; c < 3; ++c) {
    size = std::max(size, std::abs(kronrod[c]));
    error = std::max(error, std::abs(kronrod[c] - gauss[c]));
  }
  if (error <= tolerance * size || depth > 40) {
    return kronrod;
  }
  const Three left = integrate(f, a, middle, tolerance, size * 0.5, depth + 1);
  const Three right = integrate(f, middle, b, tolerance, size * 0.5, depth + 1);
  return {left[0] + right[0], left[1] + right[1], left[2] + right[2]};
}

inline Three densities(const shared::Medium& m, double h) {
  if (h > m.atmosphere_height_m) {
    return {};
  }
  const double tent = 1.0 - std::abs(h - m.ozone_centre_m) / m.ozone_half_width_m;
  return {std::exp(-h / m.rayleigh_scale_height_m), std::exp(-h / m.mie_scale_height_m), std::max(tent, 0.0)};
}

// Returns 0, d and the distances between them, in order, at which the line from radius r0 with cosine mu crosses shells
// where the integrand has a kink, and its perigee.
inline std::vector<double> breaks(const shared::Medium& m, double h0, double mu, double d) {
  const long double radius = m.planet_radius_m;
  const long double r0 = radius + h0;
  std::vector<double> out = {0.0, d};
  const double ozone = m.ozone_centre_m;
  const double width = m.ozone_half_width_m;
  const double fine = m.mie_scale_height_m;
  for (const double h :
       {ozone - width, ozone, ozone + width, 1.0 * m.atmosphere_height_m, 0.0, fine, 3.0 * fine, 8.0 * fine}) {
    const long double r = radius + h;
    const long double discriminant = r0 * mu * r0 * mu - (r0 - r) * (r0 + r);
    if (discriminant >= 0.0) {
      const long double root = std::sqrt(discriminant);
      out.push_back(static_cast<double>(-r0 * mu - root));
      out.push_back(static_cast<double>(-r0 * mu + root));
    }
  }
  out.push_back(static_cast<double>(-r0 * mu));
  std::erase_if(out, [d](double x) { return x < 0.0 || x > d; });
  std::sort(out.begin(), out.end());
  return out;
}

// Returns the integrals of the three densities over distance d from altitude h0, each to its own relative precision.
inline Three column(const shared::Medium& m, double h0, double mu, double d, double tolerance = 1.0e-8) {
  const double radius = m.planet_radius_m;
  const double r0 = radius + h0;
  const auto f = [&](double x) {
    const double rise = x * (2.0 * r0 * mu + x);
    return densities(m, h0 + rise / (std::sqrt(r0 * r0 + rise) + r0));
  };
  Three sum = {};
  const std::vector<double> at = breaks(m, h0, mu, d);
  for (std::size_t i = 1; i < at.size(); ++i) {
    const Three part = integrate(f, at[i - 1], at[i], tolerance, 1.0e-12);
    for (int c = 0; c < 3; ++c) {
      sum[c] += part[c];
    }
  }
  return sum;
}

// Returns the distance from (h0, mu) to the farther crossing of the shell of altitude h; negative if there is none.
inline double far_crossing(const shared::Medium& m, double h0, double mu, double h) {
  const long double r0 = static_cast<long double>(m.planet_radius_m) + h0;
  const long double r = static_cast<long double>(m.planet_radius_m) + h;
  const long double discriminant = r0 * mu * r0 * mu - (r0 - r) * (r0 + r);
  return discriminant < 0.0 ? -1.0 : static_cast<double>(-r0 * mu + std::sqrt(discriminant));
}
inline double near_crossing(const shared::Medium& m, double h0, double mu, double h) {
  const long double r0 = static_cast<long double>(m.planet_radius_m) + h0;
  const long double r = static_cast<long double>(m.planet_radius_m) + h;
  const long double discriminant = r0 * mu * r0 * mu - (r0 - r) * (r0 + r);
  return discriminant < 0.0 ? -1.0 : static_cast<double>(-r0 * mu - std::sqrt(discriminant));
}

inline Three optical_depth(const shared::Medium& m, const Three& n) {
  const Three r = of(m.rayleigh_scattering);
  const Three e = of(m.mie_extinction);
  const Three o = of(m.ozone_absorption);
  return {r[0] * n[0] + e[0] * n[1] + o[0] * n[2], r[1] * n[0] + e[1] * n[1] + o[1] * n[2],
          r[2] * n[0] + e[2] * n[1] + o[2] * n[2]};
}

inline double rayleigh_phase(double nu) { return 3.0 / (16.0 * std::numbers::pi) * (1.0 + nu * nu); }
inline double mie_phase(const shared::Medium& m, double nu) {
  const double g = m.mie_g;
  const double base = std::pow(1.0 + g * g - 2.0 * g * nu, 1.5);
  if (m.mie_phase == 1) {
    return (1.0 - g * g) / (4.0 * std::numbers::pi * base);
  }
  return 3.0 / (8.0 * std::numbers::pi) * (1.0 - g * g) * (1.0 + nu * nu) / ((2.0 + g * g) * base);
}

// Returns radiance / E0 of single scattering from altitude h0 over black ground, to the given relative tolerance.
inline Three single_scattering(const shared::Medium& m, double h0, double mu, double mu_s, double azimuth,
                               double tolerance) {
  const double radius = m.planet_radius_m;
  const Point origin = {0.0, radius + h0, 0.0};
  const Point view = {std::sqrt(std::max(1.0 - mu * mu, 0.0)), mu, 0.0};
  const double sin_s = std::sqrt(std::max(1.0 - mu_s * mu_s, 0.0));
  const Point sun = {sin_s * std::cos(azimuth), mu_s, sin_s * std::sin(azimuth)};
  const double top = m.atmosphere_height_m;
  double start = 0.0;
  double end = far_crossing(m, h0, mu, top);
  if (end <= 0.0) {
    return {};
  }
  if (h0 > top) {
    start = near_crossing(m, h0, mu, top);
  }
  // For a ray from below sea level, the ground is at twice its depth.
  const double ground = near_crossing(m, h0, mu, 2.0 * std::min(h0, 0.0));
  if (ground > 0.0 || (h0 == 0.0 && mu < 0.0)) {
    end = std::max(ground, 0.0);
  }
  // A point is lit if the ray to the sun misses the planet.
  const auto lit = [&](double d) {
    const Point p = along(origin, view, d);
    const double z = dot(p, sun);
    if (z >= 0.0) {
      return true;
    }
    const Point off = along(p, sun, -z);
    return std::sqrt(dot(off, off)) >= radius;
  };
  std::vector<double> at = breaks(m, h0, mu, end);
  std::erase_if(at, [start](double d) { return d < start; });
  at.insert(at.begin(), start);
  constexpr int kScan = 4000;
  for (int i = 0; i < kScan; ++i) {
    double a = start + (end - start) * i / kScan;
    double b = start + (end - start) * (i + 1) / kScan;
    if (lit(a) != lit(b)) {
      const bool first = lit(a);
      for (int j = 0; j < 60; ++j) {
        const double middle = 0.5 * (a + b);
        (lit(middle) == first ? a : b) = middle;
      }
      at.push_back(0.5 * (a + b));
    }
  }
  std::sort(at.begin(), at.end());
  const double nu = dot(view, sun);
  const Three rayleigh = of(m.rayleigh_scattering);
  const Three mie = of(m.mie_scattering);
  const auto integrand = [&](double d) -> Three {
    const Point p = along(origin, view, d);
    const double r = std::sqrt(dot(p, p));
    const double rise = d * (2.0 * origin.y * mu + d);
    const double h = h0 + rise / (r + origin.y);
    const double cos_sun = dot(p, sun) / r;
    const Three to_sun = column(m, h, cos_sun, std::max(far_crossing(m, h, cos_sun, top), 0.0), 0.1 * tolerance);
    const Three to_camera = column(m, h0, mu, d, 0.1 * tolerance);
    const Three tau = optical_depth(m, {to_sun[0] + to_camera[0], to_sun[1] + to_camera[1], to_sun[2] + to_camera[2]});
    const Three density = densities(m, std::min(h, top));
    Three out;
    for (int c = 0; c < 3; ++c) {
      out[c] =
          std::exp(-tau[c]) * (rayleigh[c] * density[0] * rayleigh_phase(nu) + mie[c] * density[1] * mie_phase(m, nu));
    }
    return out;
  };
  Three sum = {};
  for (std::size_t i = 1; i < at.size(); ++i) {
    if (at[i] > at[i - 1] && lit(0.5 * (at[i - 1] + at[i]))) {
      const double largest = std::max({sum[0], sum[1], sum[2]});
      const Three part = integrate(integrand, at[i - 1], at[i], tolerance, std::max(largest, 1.0e-30));
      for (int c = 0; c < 3; ++c) {
        sum[c] += part[c];
      }
    }
  }
  return sum;
}

}  // namespace tyndall::brute
