// What exposure and tone mapping can be told, and their operators as functions of a colour. Nothing of a device.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace tyndall::post {

// Values of TonemapOperator in src/scene/description/scene_params.def and of shaders/post/tonemap_curves.glsl.
enum class Operator : std::uint32_t {
  exponential,
  reinhard,
  reinhard_modified,
  uncharted2,
  filmic_alu,
  logarithmic,
  adaptive_logarithmic,
  agx,
  pbr_neutral,
  exponential_channels,
};
constexpr std::uint32_t kOperators = 10;

struct TonemapSettings {
  Operator op = Operator::uncharted2;
  float middle_gray = 0.18F;  // the luminance that the adapted one becomes before the curve; with auto exposure
  float white_point = 3.0F;   // scaled luminance that becomes white, > 0; of the operators that have one
  float saturation = 1.0F;    // > 0; of the operators on luminance, and of AgX
  bool auto_exposure = true;
  bool light_adaptation = true;     // false: every picture is exposed for itself
  float least_luminance = 1.0e-4F;  // darker pictures are exposed as if they had it: night stays dark
  float exposure = 1.8F;            // scales the radiance when auto exposure is off
};

// The operator on linear radiance times `exposure`, as the GPU computes it but in double precision: linear display
// values 0 to 1. Negative radiance and what is no number is black.
[[nodiscard]] std::array<double, 3> tonemapped(const TonemapSettings& settings, double exposure,
                                               const std::array<double, 3>& radiance);

}  // namespace tyndall::post
