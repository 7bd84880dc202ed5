// The settings of exposure and tone mapping, and the operators as functions of a colour. Independent of devices.
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
  float middle_gray = 0.18F;  // with auto exposure: value to which the adapted luminance is scaled before the curve
  float white_point = 3.0F;   // scaled luminance that becomes white, > 0; for operators with a white point
  float saturation = 1.0F;    // > 0; for operators on luminance, and for AgX
  bool auto_exposure = true;
  bool light_adaptation = true;     // false: every picture is exposed independently
  float least_luminance = 1.0e-4F;  // lower limit of the luminance that sets the exposure, so that night stays dark
  float exposure = 1.8F;            // scale of the radiance without auto exposure
};

// Applies the operator to linear radiance times `exposure`, as the GPU does but in double precision. Returns linear
// display values in [0; 1]. Negative radiance and NaN are black.
[[nodiscard]] std::array<double, 3> tonemapped(const TonemapSettings& settings, double exposure,
                                               const std::array<double, 3>& radiance);

}  // namespace tyndall::post
