#include "reference/line.hpp"

#include <limits>

namespace tyndall::reference {

Line::Line(const Atmosphere& air, const Vec& origin, const Vec& direction, double ground_m)
    : air_(&air), origin_(origin), direction_(direction), ground_m_(ground_m) {
  const double r2 = dot(origin, origin);
  double s = dot(origin, direction);
  tangent2_ = std::max(0.0, r2 - s * s);
  const double ground2 = ground_m * ground_m;
  hits_ground_ = s < 0.0 && tangent2_ < ground2;
  s_top_ = std::sqrt(std::max(0.0, air.top_radius_m * air.top_radius_m - tangent2_));
  s = std::clamp(s, -s_top_, s_top_);  // removes rounding errors at the edge
  start_ = point(s);
  if (s < 0.0) {
    s_end_ = hits_ground_ ? std::max(s, -std::sqrt(ground2 - tangent2_)) : s_top_;
    lowest_ = point(hits_ground_ ? s_end_ : 0.0);
    total_ = hits_ground_ ? lowest_.to_top - start_.to_top : lowest_.to_top + lowest_.to_top - start_.to_top;
  } else {
    s_end_ = s_top_;
    total_ = start_.to_top;
  }
}

LinePoint Line::point(double s) const {
  LinePoint p;
  p.s = s;
  p.r = std::sqrt(tangent2_ + s * s);
  p.density = air_->density(p.r);
  p.to_top = air_->exponential_density_integrals(tangent2_, std::abs(s), s_top_, p.density);
  return p;
}

Amounts Line::travelled(const LinePoint& p) const {
  if (start_.s >= 0.0) return start_.to_top - p.to_top;
  if (p.s <= 0.0) return p.to_top - start_.to_top;
  return lowest_.to_top + lowest_.to_top - start_.to_top - p.to_top;
}

double Line::ozone_travelled(double s) const {
  const auto to_top = [&](double at) { return air_->ozone_density_integral(tangent2_, std::abs(at), s_top_); };
  // The path is never higher than the higher of its two ends.
  if (!air_->reaches_ozone(std::sqrt(tangent2_ + std::max(s * s, start_.s * start_.s)))) return 0.0;
  if (start_.s >= 0.0) return std::max(0.0, to_top(start_.s) - to_top(s));
  if (s <= 0.0) return std::max(0.0, to_top(s) - to_top(start_.s));
  return std::max(0.0, 2.0 * to_top(0.0) - to_top(start_.s) - to_top(s));
}

LinePoint Line::invert(std::size_t channel, double depth) const {
  const double from_start = air_->exponential_depth(start_.to_top, channel);
  // `target` is the optical depth from the solution to the top. The solution's distance |s| from the tangent point is
  // in [low; high].
  const LinePoint* known = &start_;
  double low = std::max(start_.s, 0.0), high = s_top_;
  double target = from_start - depth;
  bool descending = false;
  if (start_.s < 0.0) {
    const double at_lowest = air_->exponential_depth(lowest_.to_top, channel);
    if (hits_ground_ || depth <= at_lowest - from_start) {
      descending = true;
      low = std::abs(lowest_.s);
      high = std::abs(start_.s);
      target = from_start + depth;
      if (target - from_start > 0.5 * (at_lowest - from_start)) known = &lowest_;
    } else {
      target = 2.0 * at_lowest - from_start - depth;
      known = &lowest_;
    }
  }
  const double sign = descending ? -1.0 : 1.0;
  const double tolerance = 1e-3 * air_->exponential_depth(total_, channel);
  target = std::max(target, std::numeric_limits<double>::min());

  LinePoint p = *known;
  double s = std::abs(p.s);
  for (int iteration = 0; iteration < 60; ++iteration) {
    const double to_top = air_->exponential_depth(p.to_top, channel);
    double next = 0.5 * (low + high);
    bool close = false;
    if (to_top > 0.0) {
      const double error = std::log(to_top / target);
      if (error > 0.0) {
        low = std::max(low, s);
      } else {
        high = std::min(high, s);
      }
      const double rayleigh = air_->rayleigh_scattering[channel] * p.density.rayleigh;
      const double mie = air_->mie_extinction[channel] * p.density.mie;
      const double slope = (rayleigh + mie) / to_top;
      const double fall =
          s / p.r * (rayleigh / air_->rayleigh_scale_height_m + mie / air_->mie_scale_height_m) / (rayleigh + mie);
      double divisor = slope - 0.5 * error * (fall - slope);
      if (divisor < 0.25 * slope) divisor = slope;
      next = s + error / divisor;
      // The step's own error is of third order, so the error after this step is negligible.
      close = std::abs(error) < 1e-3 && std::abs(error) * to_top < tolerance;
      if (!(next > low && next < high)) next = close ? std::clamp(next, low, high) : 0.5 * (low + high);
    } else {
      high = std::min(high, s);
    }
    s = next;
    p = point(sign * s);
    if (close || high - low <= 1e-9 * s_top_) break;
  }
  return p;
}

Interval Line::shadow(const Vec& sun, double radius_m) const {
  const double reach = s_end_ - start_.s;
  const double along = dot(direction_, sun), depth = dot(origin_, sun);
  Interval t{0.0, reach};
  // First clip to the half space behind the planet's centre, as seen from the sun.
  if (along > 0.0) {
    t.to = std::min(t.to, -depth / along);
  } else if (along < 0.0) {
    t.from = std::max(t.from, -depth / along);
  } else if (depth >= 0.0) {
    return {};
  }
  if (!(t.from < t.to)) return {};
  // Then clip to the cylinder of that radius around the axis towards the sun.
  const double a = (1.0 - along) * (1.0 + along);
  const double b = start_.s - depth * along;
  const double c = dot(origin_, origin_) - depth * depth - radius_m * radius_m;
  if (a < 1e-14) return c < 0.0 ? Interval{t.from + start_.s, t.to + start_.s} : Interval{};
  const double discriminant = b * b - a * c;
  if (!(discriminant > 0.0)) return {};
  const double root = std::sqrt(discriminant);
  t.from = std::max(t.from, (-b - root) / a);
  t.to = std::min(t.to, (-b + root) / a);
  if (!(t.from < t.to)) return {};
  return {t.from + start_.s, t.to + start_.s};
}

bool sunward_integrals(const Atmosphere& air, const Vec& position, double r, const Amounts& density, const Vec& sun,
                       Amounts& integrals) {
  const double s = dot(position, sun);
  const double tangent2 = std::max(0.0, r * r - s * s);
  if (s < 0.0 && tangent2 < air.radius_m * air.radius_m) return false;
  const double s_top = std::sqrt(std::max(0.0, air.top_radius_m * air.top_radius_m - tangent2));
  integrals = air.density_integrals_to_top(tangent2, std::abs(s), s_top, density);
  if (s < 0.0) {
    const Amounts tangent = air.density_integrals_to_top(tangent2, 0.0, s_top, air.density(std::sqrt(tangent2)));
    integrals = tangent + tangent - integrals;
  }
  return true;
}

}  // namespace tyndall::reference
