// The steps of an update of a sky probe.
#pragma once

#include <vector>

#include "effect/step.hpp"

namespace tyndall {

// Returns the steps of an update. Each is a slice that SkyProbe::record() counts. The last one writes the coefficients.
// The first push constant is the first row of the quadrature, or the first texel of the cube map; the second one is the
// level of the cube map. cube_size: as in SkyProbeDesc.
[[nodiscard]] std::vector<Step> sky_probe_steps(ColorMode color, std::uint32_t cube_size);

}  // namespace tyndall
