// Error measures between two images.
#include "image/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace tyndall::image {

Metrics compare(const Image& a, const Image& b) {
  Metrics metrics;
  metrics.non_finite_a = count_non_finite(a);
  metrics.non_finite_b = count_non_finite(b);
  std::size_t count = 0;
  double squares = 0.0;
  double reference = 0.0;
  for (std::size_t i = 0; i < b.rgb.size(); ++i) {
    if (!std::isfinite(a.rgb[i]) || !std::isfinite(b.rgb[i])) continue;
    const double error = std::fabs(static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i]));
    squares += error * error;
    reference += std::fabs(static_cast<double>(b.rgb[i]));
    metrics.max_abs = std::max(metrics.max_abs, error);
    ++count;
  }
  if (count == 0) return metrics;
  const double values = static_cast<double>(count);
  metrics.rmse = std::sqrt(squares / values);
  metrics.psnr_db = -20.0 * std::log10(metrics.rmse);
  const double floor = kRelativeFloor * reference / values;
  std::vector<double> relative;
  relative.reserve(count);
  for (std::size_t i = 0; i < b.rgb.size(); ++i) {
    if (!std::isfinite(a.rgb[i]) || !std::isfinite(b.rgb[i])) continue;
    const double error = std::fabs(static_cast<double>(a.rgb[i]) - static_cast<double>(b.rgb[i]));
    const double scale = std::max(std::fabs(static_cast<double>(b.rgb[i])), floor);
    relative.push_back(error == 0.0 ? 0.0 : scale > 0.0 ? error / scale : 1.0);
  }
  metrics.mean_relative_error = std::accumulate(relative.begin(), relative.end(), 0.0) / values;
  const auto remaining = static_cast<std::ptrdiff_t>(std::ceil((1.0 - kTrimmed) * values));
  std::nth_element(relative.begin(), relative.begin() + remaining - 1, relative.end());
  metrics.trimmed_relative_error =
      std::accumulate(relative.begin(), relative.begin() + remaining, 0.0) / static_cast<double>(remaining);
  return metrics;
}

Image difference(const Image& a, const Image& b, float gain) {
  Image result(a.width, a.height);
  for (std::size_t i = 0; i < result.rgb.size(); ++i) {
    const bool finite = std::isfinite(a.rgb[i]) && std::isfinite(b.rgb[i]);
    result.rgb[i] = finite ? std::fabs(a.rgb[i] - b.rgb[i]) * gain : 1.0F;
  }
  return result;
}

}  // namespace tyndall::image
