// Properties of the parameters that several parts of the effect depend on.
#pragma once

#include "tyndall/params.hpp"

namespace tyndall {

[[nodiscard]] inline bool is_homogeneous(const ScatteringParams& p) { return p.medium == MediumKind::homogeneous; }
[[nodiscard]] inline bool is_downscaled(const Params& params) { return params.scattering.downscale > 1; }

}  // namespace tyndall
