// Properties of the parameters that several parts of the effect depend on.
#pragma once

#include "tyndall/params.hpp"

namespace tyndall {

[[nodiscard]] inline bool is_homogeneous(const ScatteringParams& p) { return p.medium == MediumKind::homogeneous; }
[[nodiscard]] inline bool is_downscaled(const Params& params) { return params.scattering.downscale > 1; }
// Returns whether pictures read the scattering tables.
[[nodiscard]] inline bool reads_tables(const ScatteringParams& p) {
  return !is_homogeneous(p) && (p.single == SingleScattering::table || p.multiple != MultipleScattering::none);
}
// Returns whether marching reads the shadow maps.
[[nodiscard]] inline bool marches_shadows(const ScatteringParams& p) {
  return p.light_shafts &&
         (p.single != SingleScattering::none || (!is_homogeneous(p) && p.multiple == MultipleScattering::occluded));
}

}  // namespace tyndall
