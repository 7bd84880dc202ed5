// The scale function of one species for one planet. O'Neil found it with graphical analysis software; this is a
// least-squares fit.
#pragma once

#include "effect/shared.hpp"
#include "models/oneil.hpp"

namespace tyndall::models {

// Returns the published polynomial for any scale height. It was made for a scale height of a quarter of an atmosphere
// that is 2.5 % of the planet's radius thick.
[[nodiscard]] shared::OneilScale published_scale(double scale_height_m);

// Fits an atmosphere that ends at top_m, to the logarithm of numerical density integrals at Chebyshev nodes, with the
// bend that minimises the largest error.
[[nodiscard]] shared::OneilScale fit_scale(double scale_height_m, double radius_m, double top_m);

}  // namespace tyndall::models
