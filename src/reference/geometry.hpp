// Vectors and straight lines around the planet's centre, in double precision. A line is given by its tangent radius
// (the smallest distance to the centre, as a square) and a position s on it, in metres from the tangent point: r =
// sqrt(tangent2 + s^2), and s = r cos(zenith angle).
#pragma once

#include <algorithm>
#include <cmath>

namespace tyndall::reference {

struct Vec {
  double x = 0.0, y = 0.0, z = 0.0;
};

inline Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator*(const Vec& a, double k) { return {a.x * k, a.y * k, a.z * k}; }
inline double dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(const Vec& a) { return std::sqrt(dot(a, a)); }
inline Vec normalized(const Vec& a) { return a * (1.0 / length(a)); }

// Returns the direction at the angle acos(cosine) from the unit vector `axis`, rotated around it by the angle with the
// given cosine and sine. The basis is branchless after Duff et al., "Building an Orthonormal Basis, Revisited" (2017).
inline Vec around(const Vec& axis, double cosine, double cos_turn, double sin_turn) {
  const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
  const double sign = std::copysign(1.0, axis.z);
  const double a = -1.0 / (sign + axis.z);
  const double b = axis.x * axis.y * a;
  const double u = sine * cos_turn, v = sine * sin_turn;
  return normalized({(1.0 + sign * axis.x * axis.x * a) * u + b * v + axis.x * cosine,
                     sign * b * u + (sign + axis.y * axis.y * a) * v + axis.y * cosine,
                     -sign * axis.x * u - axis.y * v + axis.z * cosine});
}

}  // namespace tyndall::reference
