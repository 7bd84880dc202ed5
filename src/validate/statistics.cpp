#include "validate/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace tyndall::validate {

Rgb relative_error(const Rgb& model, const Rgb& reference) {
  const double largest = *std::max_element(reference.begin(), reference.end());
  Rgb out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = std::abs(model[c] - reference[c]) / largest;
  return out;
}

Summary summarise(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  std::sort(values.begin(), values.end());
  Summary out;
  out.count = values.size();
  if (values.empty()) return out;
  for (const double value : values) out.mean += value / static_cast<double>(values.size());
  const auto quantile = [&](double q) {
    const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
    return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
  };
  out.median = quantile(0.5);
  out.p95 = quantile(0.95);
  out.worst = values.back();
  return out;
}

ErrorSummary summarise(std::span<const Comparison> comparisons) {
  ErrorSummary out;
  std::vector<double> all;
  std::vector<double> noise;
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> channel;
    for (const Comparison& comparison : comparisons) {
      channel.push_back(comparison.error[c]);
      noise.push_back(comparison.noise[c]);
    }
    all.insert(all.end(), channel.begin(), channel.end());
    out.channels[c] = summarise(std::move(channel));
  }
  out.all = summarise(std::move(all));
  out.noise = summarise(std::move(noise)).mean;
  return out;
}

}  // namespace tyndall::validate
