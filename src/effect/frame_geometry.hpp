// What the matrices of a frame say about themselves, in double precision: which conventions they follow, and
// where the camera and the view lie in a shadow map. For the checks of inputs.
#pragma once

#include "tyndall/effect.hpp"

namespace tyndall {

[[nodiscard]] double dot(const DVec3& a, const DVec3& b);
[[nodiscard]] DVec3 cross(const DVec3& a, const DVec3& b);
[[nodiscard]] double length(const DVec3& v);
// Rows and columns of the upper left 3 x 3.
[[nodiscard]] DVec3 row_of(const Mat4& m, int row);
[[nodiscard]] DVec3 column_of(const Mat4& m, int column);

// 0 for a last row of (0, 0, 0, 1), else the largest difference from it.
[[nodiscard]] double affine_error(const Mat4& m);
// Of the first three columns: how far their lengths are from 1, or the cosine between two of them, whichever
// is larger.
[[nodiscard]] double orthonormal_error(const Mat4& m);
[[nodiscard]] double determinant3(const Mat4& m);
// Of a matrix without scale: its transpose about the translation.
[[nodiscard]] Mat4 rigid_inverse(const Mat4& m);

// Of clip_from_view, with w scaled so that it is the distance from the centre of projection where that is
// possible.
struct Projection {
  bool perspective = false;
  DVec3 centre;            // [m], in view space: the eye, which should be at its origin
  bool forward = false;    // looks down -z
  double depth_far = 0.0;  // device depth on the axis: depth_far + depth_slope / distance
  double depth_slope = 0.0;
  bool oblique = false;  // the near plane is not at right angles to the axis
  bool y_up = false;     // the picture's y points upwards, or x to the left
};
[[nodiscard]] Projection projection_of(const Mat4& clip_from_view);
// Distance on the axis at which the device depth is reached [m]; infinite for depth_far itself, and where
// there is none.
[[nodiscard]] double distance_at_depth(const Projection& p, double depth);

}  // namespace tyndall
