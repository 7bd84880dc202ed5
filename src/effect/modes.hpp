// The modes of scattering.* that shaders are specialised for (shaders/frame/modes.glsl): one pipeline for each
// combination that differs, made when it is first asked for or by Effect::prepare_pipelines().
#pragma once

#include <array>
#include <cstdint>

#include "gpu/pipeline.hpp"
#include "tyndall/params.hpp"

namespace tyndall {

constexpr std::uint32_t kModeCount = 3 * 2 * 2;

// Index of the pipeline for a set of parameters.
[[nodiscard]] inline std::uint32_t mode_index(const ScatteringParams& p) {
  const bool occluded = p.multiple == MultipleScattering::occluded;
  const bool each = (p.single == SingleScattering::table || occluded) && p.sections == LitSections::each;
  return (static_cast<std::uint32_t>(p.single) * 2 + (occluded ? 1 : 0)) * 2 + (each ? 1 : 0);
}

// Its constants: ids 0 single, 1 whether the higher orders are occluded, 2 sections.
[[nodiscard]] inline std::array<gpu::Constant, 3> mode_constants(std::uint32_t index) {
  return {{{0, index / 4}, {1, index / 2 % 2}, {2, index % 2}}};
}

// Whether mode_index() ever gives it: sections tell nothing apart where no table is cut by shadows.
[[nodiscard]] inline bool mode_exists(std::uint32_t index) {
  const bool lit_tables = index / 4 == static_cast<std::uint32_t>(SingleScattering::table) || index / 2 % 2 == 1;
  return lit_tables || index % 2 == 0;
}

}  // namespace tyndall
