#include "scene/elevation/elevation_fill.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tyndall::scene {

void fill_holes(std::vector<float>& values, int width, int height) {
  if (std::none_of(values.begin(), values.end(), [](float v) { return std::isnan(v); })) return;
  const auto at = [](int x, int y, int w) { return static_cast<std::size_t>(y) * w + x; };
  const int half_width = (width + 1) / 2;
  const int half_height = (height + 1) / 2;
  if (width == 1 && height == 1) return;

  std::vector<float> half(static_cast<std::size_t>(half_width) * half_height);
  for (int y = 0; y < half_height; ++y) {
    for (int x = 0; x < half_width; ++x) {
      double sum = 0.0;
      int count = 0;
      for (int j = 2 * y; j < std::min(2 * y + 2, height); ++j) {
        for (int i = 2 * x; i < std::min(2 * x + 2, width); ++i) {
          const float v = values[at(i, j, width)];
          if (std::isnan(v)) continue;
          sum += v;
          ++count;
        }
      }
      half[at(x, y, half_width)] = count > 0 ? static_cast<float>(sum / count) : std::nanf("");
    }
  }
  fill_holes(half, half_width, half_height);

  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float& v = values[at(x, y, width)];
      if (!std::isnan(v)) continue;
      const float u = std::max(0.5F * static_cast<float>(x) - 0.25F, 0.0F);
      const float w = std::max(0.5F * static_cast<float>(y) - 0.25F, 0.0F);
      const int x0 = static_cast<int>(u);
      const int y0 = static_cast<int>(w);
      const int x1 = std::min(x0 + 1, half_width - 1);
      const int y1 = std::min(y0 + 1, half_height - 1);
      const float fx = u - static_cast<float>(x0);
      const float fy = w - static_cast<float>(y0);
      const float north = std::lerp(half[at(x0, y0, half_width)], half[at(x1, y0, half_width)], fx);
      const float south = std::lerp(half[at(x0, y1, half_width)], half[at(x1, y1, half_width)], fx);
      v = std::lerp(north, south, fy);
    }
  }
}

}  // namespace tyndall::scene
