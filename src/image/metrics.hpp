// Difference measures of two images. The second image is the reference.
#pragma once

#include <cstddef>

#include "image/image.hpp"

namespace tyndall::image {

// The differences over all 3 * width * height values as the files store them (PNG: encoded [0; 1], EXR: linear). Values
// that are not finite in one of the images are excluded and counted.
struct Metrics {
  double rmse = 0.0;     // root of the mean squared difference
  double psnr_db = 0.0;  // 20 log10(1 / rmse): the peak is 1 for both kinds; infinite for equal images
  // Mean of |a - b| / max(|b|, floor), where floor is kRelativeFloor times the mean of |b|. Very dark values do not
  // dominate, and the result is independent of the unit. It is 1 where b is zero everywhere and a is not.
  double mean_relative_error = 0.0;
  double max_abs = 0.0;  // largest |a - b|
  // The mean relative error without the fraction kTrimmed of values that have the largest errors. This excludes edges,
  // which drivers may draw some hundredths of a pixel apart, and textures as fine as pixels.
  double trimmed_relative_error = 0.0;
  std::size_t non_finite_a = 0;  // values that are NaN or infinite
  std::size_t non_finite_b = 0;
};

constexpr double kRelativeFloor = 1e-3;
constexpr double kTrimmed = 0.05;  // fraction of all values

// Compares two images. Precondition: equal sizes.
[[nodiscard]] Metrics compare(const Image& a, const Image& b);

// Returns |a - b| * gain per value; values that are not finite in either image give 1. Precondition: equal sizes.
[[nodiscard]] Image difference(const Image& a, const Image& b, float gain = 16.0F);

}  // namespace tyndall::image
