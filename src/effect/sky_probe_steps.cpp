#include "effect/sky_probe_steps.hpp"

#include "effect_shaders.hpp"

namespace tyndall {
namespace {

constexpr std::uint32_t kRowsPerStep = 6;
constexpr std::size_t kSteps = shared::kSkyProbeRows / kRowsPerStep + 1;
static_assert(shared::kSkyProbeRows % kRowsPerStep == 0 && shared::kSkyProbeRows == 4 * shared::kSkyProbeNodes);

std::array<Step, kSteps> make_steps(ColorMode color) {
  std::array<Step, kSteps> out;
  for (std::uint32_t i = 0; i + 1 < kSteps; ++i) {
    out[i].name = "sky_rows";
    out[i].pipeline = pipeline_key(variant_for(shaders::sky_rows_comp, Target::cpu, color), {});
    out[i].invocations = {kRowsPerStep * shared::kSkyProbeAzimuths, 1, 1};
    out[i].push = {i * kRowsPerStep, 0};
  }
  out.back().name = "sky_coefficients";
  out.back().pipeline = pipeline_key(shaders::sky_coefficients_comp, {});
  return out;
}

}  // namespace

std::span<const Step> sky_probe_steps(ColorMode color) {
  static const std::array<Step, kSteps> rgb = make_steps(ColorMode::rgb);
  static const std::array<Step, kSteps> spectral = make_steps(ColorMode::spectral);
  return color == ColorMode::spectral ? spectral : rgb;
}

}  // namespace tyndall
