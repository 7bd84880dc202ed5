// A straight light path inside the atmosphere: its optical depth, the inversion of it, and the part where the planet
// hides the sun. Positions s are as in geometry.hpp.
#pragma once

#include "reference/atmosphere.hpp"

namespace tyndall::reference {

// A position on a line, with derived values.
struct LinePoint {
  double s = 0.0;
  double r = 0.0;
  Amounts density;
  Amounts to_top;  // density integrals along the line from here upwards to the top, without ozone
};

struct Interval {
  double from = 0.0, to = 0.0;  // empty unless from < to
};

class Line {
 public:
  // Creates the line from `origin`, inside the atmosphere or on its edge, in the unit direction `direction` to the
  // ground or to the top. The ground is a sphere of radius `ground_m`. `air` must outlive the line.
  Line(const Atmosphere& air, const Vec& origin, const Vec& direction, double ground_m);
  // Creates the line with the ground at sea level or, if the origin is below sea level, at the origin.
  Line(const Atmosphere& air, const Vec& origin, const Vec& direction)
      : Line(air, origin, direction, std::min(air.radius_m, length(origin))) {}

  [[nodiscard]] bool hits_ground() const { return hits_ground_; }
  [[nodiscard]] double ground_radius() const { return ground_m_; }
  [[nodiscard]] double start() const { return start_.s; }
  [[nodiscard]] double end() const { return s_end_; }
  [[nodiscard]] Vec position(double s) const { return origin_ + direction_ * (s - start_.s); }
  [[nodiscard]] const Vec& direction() const { return direction_; }

  [[nodiscard]] LinePoint point(double s) const;
  // Return the density integrals, without ozone, from the start to a point of the line and to its end.
  [[nodiscard]] Amounts travelled(const LinePoint& p) const;
  [[nodiscard]] const Amounts& total() const { return total_; }
  // Returns the density integral of ozone from the start to position s.
  [[nodiscard]] double ozone_travelled(double s) const;

  // Returns the point where the optical depth of `channel` (without ozone), counted from the start, is `depth`.
  // Precondition: 0 <= depth <= that of total(). Uses Halley's method on the logarithm of the depth to the top, which
  // is nearly linear (flat atmosphere) or quadratic (near the tangent point) in s.
  [[nodiscard]] LinePoint invert(std::size_t channel, double depth) const;

  // Returns the part of the line in the shadow of a sphere of the given radius around the planet's centre. It is a
  // single interval because the cylinder and the half space are convex.
  [[nodiscard]] Interval shadow(const Vec& sun, double radius_m) const;

 private:
  const Atmosphere* air_;
  Vec origin_, direction_;
  double ground_m_;
  double tangent2_ = 0.0, s_top_ = 0.0, s_end_ = 0.0;
  bool hits_ground_ = false;
  LinePoint start_;
  LinePoint lowest_;  // the ground or the tangent point; valid if start_.s < 0
  Amounts total_;
};

// Computes the density integrals from a point in the atmosphere with the given densities to the sun. Returns false if
// the planet hides the sun.
bool sunward_integrals(const Atmosphere& air, const Vec& position, double r, const Amounts& density, const Vec& sun,
                       Amounts& integrals);

}  // namespace tyndall::reference
