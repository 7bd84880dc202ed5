// Analyses the matrices of a frame for the checks of inputs, in double precision: which conventions they follow, and
// the position of the camera and the view in a shadow map.
#pragma once

#include "tyndall/effect.hpp"

namespace tyndall {

[[nodiscard]] double dot(const DVec3& a, const DVec3& b);
[[nodiscard]] DVec3 cross(const DVec3& a, const DVec3& b);
[[nodiscard]] double length(const DVec3& v);
// Return rows and columns of the upper left 3 x 3 matrix.
[[nodiscard]] DVec3 row_of(const Mat4& m, int row);
[[nodiscard]] DVec3 column_of(const Mat4& m, int column);

// Returns the largest difference of the last row from (0, 0, 0, 1).
[[nodiscard]] double affine_error(const Mat4& m);
// Returns the deviation of the first three columns from orthonormality: the largest difference of a length from 1, or
// the largest cosine between two of them, whichever is larger.
[[nodiscard]] double orthonormal_error(const Mat4& m);
[[nodiscard]] double determinant3(const Mat4& m);
// Returns the inverse of a rigid matrix.
[[nodiscard]] Mat4 rigid_inverse(const Mat4& m);

// Properties of clip_from_view. If possible, w is scaled so that it is the distance from the centre of projection.
struct Projection {
  bool perspective = false;
  DVec3 centre;            // centre of projection in view space [m], which should be the origin
  bool forward = false;    // looks down -z
  double depth_far = 0.0;  // device depth on the axis: depth_far + depth_slope / distance
  double depth_slope = 0.0;
  bool oblique = false;  // the near plane is not perpendicular to the axis
  bool y_up = false;     // the picture's y points upwards, or x to the left
};
[[nodiscard]] Projection projection_of(const Mat4& clip_from_view);
// Returns the distance on the axis with this device depth [m]. Infinite for depth_far, and if there is no such
// distance.
[[nodiscard]] double distance_at_depth(const Projection& p, double depth);

}  // namespace tyndall
