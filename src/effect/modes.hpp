// The modes of scattering.* that shaders are specialised for (shaders/frame/modes.glsl): one pipeline for each
// combination that differs, all created with the effect, so that switching costs nothing.
#pragma once

#include <array>
#include <cstdint>

#include "gpu/pipeline.hpp"
#include "tyndall/params.hpp"

namespace tyndall {

constexpr std::uint32_t kModeCount = 3 * 3 * 2;

// Index of the pipeline for a set of parameters.
[[nodiscard]] inline std::uint32_t mode_index(const ScatteringParams& p) {
  const bool lit_tables = p.single == SingleScattering::table || p.multiple == MultipleScattering::occluded;
  const std::uint32_t sections = lit_tables ? static_cast<std::uint32_t>(p.sections) : 0;
  return (static_cast<std::uint32_t>(p.single) * 3 + static_cast<std::uint32_t>(p.multiple)) * 2 + sections;
}

// Its constants: ids 0 single, 1 multiple, 2 sections.
[[nodiscard]] inline std::array<gpu::Constant, 3> mode_constants(std::uint32_t index) {
  return {{{0, index / 6}, {1, index / 2 % 3}, {2, index % 2}}};
}

// Whether mode_index() ever gives it.
[[nodiscard]] inline bool mode_exists(std::uint32_t index) {
  ScatteringParams p;
  p.single = static_cast<SingleScattering>(index / 6);
  p.multiple = static_cast<MultipleScattering>(index / 2 % 3);
  p.sections = static_cast<LitSections>(index % 2);
  return mode_index(p) == index;
}

}  // namespace tyndall
