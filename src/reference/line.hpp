// A straight path of light inside the atmosphere: its optical depth, its inversion, and where on it the
// sun is hidden behind the planet. Positions s are measured as geometry.hpp says.
#pragma once

#include "reference/atmosphere.hpp"

namespace tyndall::reference {

// A position on a line with everything known about it.
struct LinePoint {
  double s = 0.0;
  double r = 0.0;
  Amounts density;
  Amounts to_top;  // columns from here to the top, upwards along the line; ozone is not filled in
};

struct Interval {
  double from = 0.0, to = 0.0;  // empty unless from < to
};

class Line {
 public:
  // From `origin` inside the atmosphere (or on its edge) in unit direction `direction`, to the ground or
  // to the top. The ground is a sphere of radius `ground_m`. `air` has to outlive the line.
  Line(const Atmosphere& air, const Vec& origin, const Vec& direction, double ground_m);
  // With the ground at sea level, or, below it, at the origin of the line.
  Line(const Atmosphere& air, const Vec& origin, const Vec& direction)
      : Line(air, origin, direction, std::min(air.radius_m, length(origin))) {}

  [[nodiscard]] bool hits_ground() const { return hits_ground_; }
  [[nodiscard]] double ground_radius() const { return ground_m_; }
  [[nodiscard]] double start() const { return start_.s; }
  [[nodiscard]] double end() const { return s_end_; }
  [[nodiscard]] Vec position(double s) const { return origin_ + direction_ * (s - start_.s); }
  [[nodiscard]] const Vec& direction() const { return direction_; }

  [[nodiscard]] LinePoint point(double s) const;
  // Columns without ozone from the start to a point of the line, and to its end.
  [[nodiscard]] Amounts travelled(const LinePoint& p) const;
  [[nodiscard]] const Amounts& total() const { return total_; }
  // Column of ozone from the start to position s.
  [[nodiscard]] double ozone_travelled(double s) const;

  // Where the optical depth of `channel` (without ozone), counted from the start, is `depth`; precondition
  // 0 <= depth <= that of total(). Halley's method on the logarithm of the depth to the top, which is
  // nearly linear (flat atmosphere) or quadratic (near the tangent point) in s.
  [[nodiscard]] LinePoint invert(std::size_t channel, double depth) const;

  // The part of the line in the shadow of a sphere of the given radius around the planet's centre: one
  // interval, since cylinder and half space are convex.
  [[nodiscard]] Interval shadow(const Vec& sun, double radius_m) const;

 private:
  const Atmosphere* air_;
  Vec origin_, direction_;
  double ground_m_;
  double tangent2_ = 0.0, s_top_ = 0.0, s_end_ = 0.0;
  bool hits_ground_ = false;
  LinePoint start_;
  LinePoint lowest_;  // the ground or the tangent point; filled in when start_.s < 0
  Amounts total_;
};

// Transmittance from a point in the atmosphere, whose densities are given, to the sun; false where the
// planet hides it.
bool sun_transmittance(const Atmosphere& air, const Vec& position, double r, const Amounts& density, const Vec& sun,
                       Rgb& transmittance);

}  // namespace tyndall::reference
