// The settings of exposure and tone mapping, their measurements, and the operators as functions of a colour.
// Independent of devices. The library tyndall::post defines the functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tyndall::post {

// docs/tonemapping.md defines the operators. The values are those of the parameter tonemap.operator.
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
  float middle_gray =
      0.18F;  // >= 0; with auto exposure: value to which the adapted luminance is scaled before the curve
  float white_point = 3.0F;  // scaled luminance that becomes white, > 0; for operators with a white point
  float saturation = 1.0F;   // > 0; for operators on luminance, and for AgX
  bool auto_exposure = true;
  bool light_adaptation = true;  // false: every picture is exposed independently
  float least_luminance =
      1.0e-4F;            // > 0; lower limit of the luminance that sets the exposure, so that night stays dark
  float exposure = 1.8F;  // >= 0; scale of the radiance without auto exposure
};

// Applies the operator to linear radiance times `exposure`, as the GPU does but in double precision. Returns linear
// display values in [0; 1]. Negative radiance and NaN are black.
[[nodiscard]] std::array<double, 3> tonemapped(const TonemapSettings& settings, double exposure,
                                               const std::array<double, 3>& radiance);

constexpr std::size_t kHistogramBins = 256;
// Returns log2 of the luminance (in the picture's unit of radiance) at the centre of a histogram bin.
[[nodiscard]] double stop_of_bin(std::size_t bin);

// The luminance of one picture and the exposure that follows from it, as measured on the GPU.
struct Measurement {
  float exposure = 0.0F;                         // scale of the radiance with auto exposure
  float luminance = 0.0F;                        // luminance that the eye is adapted to
  float measured = 0.0F;                         // log-average of the picture; 0 if it is black
  float counted = 0.0F;                          // mean weight of the samples, 0 to 1; black space weighs 0
  float black = 0.0F;                            // fraction of samples darker than the histogram
  std::array<float, kHistogramBins> share = {};  // fraction of samples in each bin; all and `black` add up to 1
};

}  // namespace tyndall::post
