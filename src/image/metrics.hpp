// How much two images differ. The second image is the reference.
#pragma once

#include <cstddef>

#include "image/image.hpp"

namespace tyndall::image {

// Over all 3 * width * height values, as the files hold them (PNG: encoded 0..1, EXR: linear). Values
// that are not finite in either image are left out of the sums and counted.
struct Metrics {
  double rmse = 0.0;     // root of the mean squared difference
  double psnr_db = 0.0;  // 20 log10(1 / rmse): the peak is 1 for both kinds; infinite when equal
  // Mean of |a - b| / max(|b|, floor), floor = kRelativeFloor times the mean of |b|: very dark values do
  // not dominate, and the result does not depend on the unit. 1 where b is zero everywhere and a is not.
  double mean_relative_error = 0.0;
  double max_abs = 0.0;          // largest |a - b|
  std::size_t non_finite_a = 0;  // values that are NaN or infinite
  std::size_t non_finite_b = 0;
};

constexpr double kRelativeFloor = 1e-3;

// Precondition: equal sizes.
[[nodiscard]] Metrics compare(const Image& a, const Image& b);

// |a - b| * gain, value by value; what is not finite in either shows as 1. Precondition: equal sizes.
[[nodiscard]] Image difference(const Image& a, const Image& b, float gain = 16.0F);

}  // namespace tyndall::image
