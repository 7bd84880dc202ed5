#include "effect/frame_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tyndall {
namespace {

double entry(const Mat4& m, int row, int column) { return static_cast<double>(m.m[4 * column + row]); }

}  // namespace

double dot(const DVec3& a, const DVec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

DVec3 cross(const DVec3& a, const DVec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double length(const DVec3& v) { return std::sqrt(dot(v, v)); }

DVec3 row_of(const Mat4& m, int row) { return {entry(m, row, 0), entry(m, row, 1), entry(m, row, 2)}; }

DVec3 column_of(const Mat4& m, int column) { return {entry(m, 0, column), entry(m, 1, column), entry(m, 2, column)}; }

double affine_error(const Mat4& m) {
  return std::max(
      {std::abs(entry(m, 3, 0)), std::abs(entry(m, 3, 1)), std::abs(entry(m, 3, 2)), std::abs(entry(m, 3, 3) - 1.0)});
}

double orthonormal_error(const Mat4& m) {
  double worst = 0.0;
  for (int i = 0; i < 3; ++i) {
    const DVec3 a = column_of(m, i);
    worst = std::max({worst, std::abs(length(a) - 1.0), std::abs(dot(a, column_of(m, (i + 1) % 3)))});
  }
  return worst;
}

double determinant3(const Mat4& m) { return dot(column_of(m, 0), cross(column_of(m, 1), column_of(m, 2))); }

Mat4 rigid_inverse(const Mat4& m) {
  Mat4 out;
  const DVec3 t = column_of(m, 3);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) out.m[4 * column + row] = m.m[4 * row + column];
    out.m[12 + row] = static_cast<float>(-dot(column_of(m, row), t));
  }
  return out;
}

Projection projection_of(const Mat4& p) {
  // At the centre of projection, x, y and w of clip space are all 0. A projection with parallel rays has none.
  constexpr double kParallel = 1e-9;
  Projection out;
  const DVec3 x = row_of(p, 0);
  const DVec3 y = row_of(p, 1);
  const DVec3 w = row_of(p, 3);
  const double determinant = dot(x, cross(y, w));
  // The last row of an orthographic projection has only its constant.
  const bool constant = length(w) <= kParallel * std::abs(entry(p, 3, 3));
  if (constant || std::abs(determinant) <= kParallel * length(x) * length(y) * length(w)) return out;
  out.perspective = true;
  const DVec3 yw = cross(y, w);
  const DVec3 wx = cross(w, x);
  const DVec3 xy = cross(x, y);
  const auto along = [&](double a, double b, double c) {
    return -(entry(p, 0, 3) * a + entry(p, 1, 3) * b + entry(p, 3, 3) * c) / determinant;
  };
  out.centre = {along(yw.x, wx.x, xy.x), along(yw.y, wx.y, xy.y), along(yw.z, wx.z, xy.z)};
  const double w_per_m = -w.z;
  out.forward = w_per_m > 0.0;
  const DVec3 z = row_of(p, 2);
  out.depth_far = -z.z / w_per_m;
  out.depth_slope = (entry(p, 2, 3) - out.depth_far * entry(p, 3, 3)) / w_per_m;
  out.oblique = std::abs(z.x) + std::abs(z.y) > 1e-6 * (std::abs(z.z) + std::abs(w_per_m));
  out.y_up = x.x * y.y - x.y * y.x > 0.0;
  return out;
}

double distance_at_depth(const Projection& p, double depth) {
  const double off = depth - p.depth_far;
  const double distance = p.depth_slope / off;
  // In single precision, a distant plane has the same depth as infinity.
  if (std::abs(off) < 1e-6 || !(distance > 0.0)) return std::numeric_limits<double>::infinity();
  return distance;
}

}  // namespace tyndall
