// The steps of an update of a sky probe.
#pragma once

#include <span>

#include "effect/step.hpp"

namespace tyndall {

// Returns the steps of an update. Each is a slice that SkyProbe::record() counts. The push constant is the first row of
// the quadrature.
[[nodiscard]] std::span<const Step> sky_probe_steps(ColorMode color = ColorMode::rgb);

}  // namespace tyndall
