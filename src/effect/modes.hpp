// The modes of scattering.* that shaders are specialised for (shaders/frame/modes.glsl): one pipeline for each
// combination that differs, made when it is first asked for or by Effect::prepare_pipelines().
#pragma once

#include <array>
#include <cstdint>

#include "gpu/pipeline.hpp"
#include "tyndall/params.hpp"

namespace tyndall {

constexpr std::uint32_t kAtmosphereModes = 3 * 2 * 2;
// And two of the homogeneous medium: with its light, and without.
constexpr std::uint32_t kModeCount = kAtmosphereModes + 2;

[[nodiscard]] inline bool is_homogeneous(const ScatteringParams& p) { return p.medium == MediumKind::homogeneous; }

// Index of the pipeline for a set of parameters.
[[nodiscard]] inline std::uint32_t mode_index(const ScatteringParams& p) {
  if (is_homogeneous(p)) return kAtmosphereModes + (p.single == SingleScattering::none ? 1 : 0);
  const bool occluded = p.multiple == MultipleScattering::occluded;
  const bool each = (p.single == SingleScattering::table || occluded) && p.sections == LitSections::each;
  return (static_cast<std::uint32_t>(p.single) * 2 + (occluded ? 1 : 0)) * 2 + (each ? 1 : 0);
}

// Its constants: ids 0 single, 1 whether the higher orders are occluded, 2 sections, 5 whether the medium is
// homogeneous.
[[nodiscard]] inline std::array<gpu::Constant, 4> mode_constants(std::uint32_t index) {
  if (index >= kAtmosphereModes) {
    const auto integration = static_cast<std::uint32_t>(SingleScattering::integration);
    return {{{0, index == kAtmosphereModes ? integration : 0}, {1, 0}, {2, 0}, {5, 1}}};
  }
  return {{{0, index / 4}, {1, index / 2 % 2}, {2, index % 2}, {5, 0}}};
}

// Whether mode_index() ever gives it: sections tell nothing apart where no table is cut by shadows.
[[nodiscard]] inline bool mode_exists(std::uint32_t index) {
  if (index >= kAtmosphereModes) return true;
  const bool lit_tables = index / 4 == static_cast<std::uint32_t>(SingleScattering::table) || index / 2 % 2 == 1;
  return lit_tables || index % 2 == 0;
}

}  // namespace tyndall
