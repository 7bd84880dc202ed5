// The aerosol's phase function as shaders read it where it has no formula (air::tabulated): kPhaseNodes rows of its
// natural logarithm, one component per channel, behind the medium in the same block.
#pragma once

#include <vector>

#include "effect/shared.hpp"
#include "tyndall/params.hpp"

namespace tyndall {

using PhaseRows = std::vector<shared::vec4>;

// Size of the medium with its rows, in buffers [bytes].
constexpr std::size_t kPhaseBytes = shared::kPhaseNodes * sizeof(shared::vec4);
constexpr std::size_t kMediumBlockBytes = sizeof(shared::SpectralMedium) + kPhaseBytes;

// Returns the rows for a representation of light, or none if shaders have a formula. Precondition: check_params().
[[nodiscard]] PhaseRows phase_rows(const Params& params, ColorMode color);
// Writes the same rows to `rows`. Allocates nothing if the capacity of `rows` is kPhaseNodes.
void phase_rows(const Params& params, ColorMode color, PhaseRows& rows);

// Returns the rows from which the orders >= 2 are built: the function without the details that the gathering grid does
// not resolve. Its Legendre moments of degree l are multiplied by exp(-(l (l + 1) / 450)^1.5), so that those up to
// degree 5, which determine how light spreads, change by at most 2 %, and no narrow peak falls between the grid's
// angles. The result is not negative, whatever the function is.
[[nodiscard]] PhaseRows resolved_phase_rows(const Params& params);

// Returns whether the phase functions of two sets of parameters are equal, apart from what Medium contains.
[[nodiscard]] bool same_phase(const Params& a, const Params& b);

}  // namespace tyndall
