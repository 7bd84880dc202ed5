// The steps of a build of the scattering tables, as a pure function of the parameters and the set of stale tables.
// docs/tables.md describes the method.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "effect/step.hpp"
#include "tyndall/params.hpp"

namespace tyndall {

// Returns the steps that build the `stale` tables (bits 1 << TableId). A step is one dispatch over a few altitudes or
// columns, which Effect::record_precompute() counts as a slice. The push constants are the first altitude or column and
// the order of scattering.
[[nodiscard]] std::vector<Step> table_steps(const Params& params, std::uint32_t stale);

// Returns the names of all steps in the order of a build.
[[nodiscard]] std::span<const char* const> table_step_names();

}  // namespace tyndall
