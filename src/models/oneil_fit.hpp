// The scale function of one species for one planet: what O'Neil found once with graphical analysis software, as
// a least-squares fit.
#pragma once

#include "effect/shared.hpp"
#include "models/oneil.hpp"

namespace tyndall::models {

// The polynomial as printed, for whatever scale height: made for one of a quarter of an atmosphere that is
// 2.5 % of the planet's radius thick.
[[nodiscard]] shared::OneilScale published_scale(double scale_height_m);

// The fit for an atmosphere that ends at top_m: to columns by quadrature at Chebyshev nodes, in the logarithm,
// with the bend that leaves the least worst error.
[[nodiscard]] shared::OneilScale fit_scale(double scale_height_m, double radius_m, double top_m);

}  // namespace tyndall::models
