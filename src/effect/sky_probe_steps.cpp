#include "effect/sky_probe_steps.hpp"

#include <algorithm>

#include "effect_shaders.hpp"

namespace tyndall {
namespace {

constexpr std::uint32_t kRowsPerStep = 6;
constexpr std::uint32_t kTexelsPerStep = 1536;   // of the cube map, evaluated
constexpr std::uint32_t kFilteredPerStep = 512;  // of the cube map, filtered
static_assert(shared::kSkyProbeRows % kRowsPerStep == 0 && shared::kSkyProbeRows == 4 * shared::kSkyProbeNodes);

Step step(const char* name, const gpu::Shader& shader, std::uint32_t invocations, std::uint32_t first,
          std::uint32_t level = 0) {
  Step out;
  out.name = name;
  out.pipeline = pipeline_key(shader, {});
  out.invocations = {invocations, 1, 1};
  out.push = {first, level};
  return out;
}

void add_cube(std::vector<Step>& out, ColorMode color, std::uint32_t size) {
  const gpu::Shader& evaluation = variant_for(shaders::sky_cube_comp, Target::cpu, color);
  const std::uint32_t first_level = 6 * size * size;
  for (std::uint32_t first = 0; first < first_level; first += kTexelsPerStep) {
    out.push_back(step("sky_cube", evaluation, std::min(kTexelsPerStep, first_level - first), first));
  }
  for (std::uint32_t level = 1; size >> level >= shared::kSkyCubeCoarse; ++level) {
    const std::uint32_t texels = first_level >> (2 * level);
    out.push_back(step("sky_cube_level", shaders::sky_cube_level_comp, texels, 0, level));
  }
  const std::uint32_t all = 8 * size * size - 2;  // 6 (size^2 + (size / 2)^2 + ... + 1)
  for (std::uint32_t first = first_level; first < all; first += kFilteredPerStep) {
    const std::uint32_t texels = std::min(kFilteredPerStep, all - first);
    out.push_back(step("sky_cube_filter", shaders::sky_cube_filter_comp, texels, first));
  }
}

}  // namespace

std::vector<Step> sky_probe_steps(ColorMode color, std::uint32_t cube_size) {
  std::vector<Step> out;
  const gpu::Shader& rows = variant_for(shaders::sky_rows_comp, Target::cpu, color);
  for (std::uint32_t first = 0; first < shared::kSkyProbeRows; first += kRowsPerStep) {
    out.push_back(step("sky_rows", rows, kRowsPerStep * shared::kSkyProbeAzimuths, first));
  }
  if (cube_size > 0) add_cube(out, color, cube_size);
  out.push_back(step("sky_coefficients", shaders::sky_coefficients_comp, 1, 0));
  return out;
}

}  // namespace tyndall
