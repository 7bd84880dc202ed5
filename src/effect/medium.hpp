// Builds the medium for the shaders from the parameters, in double precision and rounded once.
#pragma once

#include "effect/shared.hpp"
#include "tyndall/params.hpp"

namespace tyndall {

// Returns the properties of planet and atmosphere for the shaders; air/coefficients.hpp defines the coefficients.
// Precondition: check_params() accepts the parameters.
[[nodiscard]] shared::Medium medium_from_params(const Params& params);

}  // namespace tyndall
