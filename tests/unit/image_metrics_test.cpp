// Error measures against values computed by hand, and the statistics of dithering.
#include "image/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace tyndall::image {
namespace {

Image image_of(std::initializer_list<float> values) {
  Image image(static_cast<std::uint32_t>(values.size() / 3), 1);
  image.rgb = values;
  return image;
}

TEST(ImageMetrics, ValuesByHand) {
  const Image a = image_of({0.5F, 0.5F, 0.5F, 1.0F, 1.0F, 1.0F});
  const Image b = image_of({0.25F, 0.5F, 0.5F, 1.0F, 0.5F, 1.0F});
  const Metrics metrics = compare(a, b);
  EXPECT_DOUBLE_EQ(metrics.rmse, std::sqrt((0.0625 + 0.25) / 6.0));
  EXPECT_NEAR(metrics.psnr_db, 10.0 * std::log10(6.0 / 0.3125), 1e-12);
  EXPECT_DOUBLE_EQ(metrics.mean_relative_error, (1.0 + 1.0) / 6.0);
  EXPECT_DOUBLE_EQ(metrics.max_abs, 0.5);
}

TEST(ImageMetrics, EqualImages) {
  const Image a = image_of({0.5F, 0.0F, 0.5F});
  const Metrics metrics = compare(a, a);
  EXPECT_EQ(metrics.rmse, 0.0);
  EXPECT_EQ(metrics.mean_relative_error, 0.0);
  EXPECT_TRUE(std::isinf(metrics.psnr_db) && metrics.psnr_db > 0);
}

TEST(ImageMetrics, RelativeErrorDoesNotDependOnTheUnit) {
  const Image a = image_of({1.0F, 2.0F, 0.0F, 4.0F, 0.5F, 1e-8F});
  const Image b = image_of({1.5F, 2.0F, 1e-7F, 5.0F, 0.5F, 0.0F});
  Image a2 = a;
  Image b2 = b;
  for (float& value : a2.rgb) value *= 1024.0F;
  for (float& value : b2.rgb) value *= 1024.0F;
  EXPECT_NEAR(compare(a, b).mean_relative_error, compare(a2, b2).mean_relative_error, 1e-12);
  // Without the floor, values of a ten-millionth of the mean would have a huge relative error.
  EXPECT_NEAR(compare(a, b).mean_relative_error, (0.5 / 1.5 + 0.2) / 6.0, 1e-4);
}

TEST(ImageMetrics, FiveValuesInAHundredAreTrimmed) {
  Image a(20, 1);
  Image b(20, 1);
  std::fill(b.rgb.begin(), b.rgb.end(), 1.0F);
  std::fill(a.rgb.begin(), a.rgb.end(), 1.25F);
  for (const std::size_t edge : {7U, 30U, 59U}) a.rgb[edge] = 9.0F;
  EXPECT_DOUBLE_EQ(compare(a, b).trimmed_relative_error, 0.25);
  EXPECT_DOUBLE_EQ(compare(a, b).mean_relative_error, 0.25 + 3.0 * 7.75 / 60.0);
  a.rgb[40] = 9.0F;
  EXPECT_DOUBLE_EQ(compare(a, b).trimmed_relative_error, 0.25 + 7.75 / 57.0) << "a fourth of 60 is too many";
}

TEST(ImageMetrics, AgainstBlack) {
  EXPECT_DOUBLE_EQ(compare(image_of({1.0F, 0.0F, 0.0F}), image_of({0.0F, 0.0F, 0.0F})).mean_relative_error, 1.0 / 3.0);
}

TEST(ImageMetrics, NotFiniteIsCountedAndLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const Metrics metrics = compare(image_of({nan, 1.0F, inf}), image_of({1.0F, 0.5F, inf}));
  EXPECT_EQ(metrics.non_finite_a, 2U);
  EXPECT_EQ(metrics.non_finite_b, 1U);
  EXPECT_DOUBLE_EQ(metrics.rmse, 0.5);
  const Image shown = difference(image_of({nan, 1.0F, inf}), image_of({1.0F, 0.5F, inf}));
  EXPECT_EQ(shown.rgb, (std::vector<float>{1.0F, 8.0F, 1.0F}));
}

TEST(ImageDither, TheMeanIsExactEverywhere) {
  constexpr std::uint32_t kSide = 128;
  for (const double steps : {0.0, 0.05, 0.3, 0.5, 0.8, 1.0, 17.25, 100.5, 254.0, 254.4, 254.7, 254.95, 255.0}) {
    for (std::uint32_t channel = 0; channel < 3; ++channel) {
      double sum = 0.0;
      int lowest = 255;
      int highest = 0;
      for (std::uint32_t y = 0; y < kSide; ++y) {
        for (std::uint32_t x = 0; x < kSide; ++x) {
          const int step = quantize(static_cast<float>(steps / 255.0), x, y, channel, true);
          sum += step;
          lowest = std::min(lowest, step);
          highest = std::max(highest, step);
        }
      }
      EXPECT_NEAR(sum / (kSide * kSide), steps, 0.01) << steps;
      EXPECT_GE(lowest, std::floor(steps) - 1);
      EXPECT_LE(highest, std::ceil(steps) + 1);
    }
  }
}

TEST(ImageDither, BlackWhiteAndBeyondAreExact) {
  for (std::uint32_t y = 0; y < 300; ++y) {
    for (std::uint32_t x = 0; x < 300; ++x) {
      ASSERT_EQ(quantize(0.0F, x, y, 0, true), 0);
      ASSERT_EQ(quantize(-3.0F, x, y, 1, true), 0);
      ASSERT_EQ(quantize(1.0F, x, y, 2, true), 255);
      ASSERT_EQ(quantize(7.0F, x, y, 0, true), 255);
    }
  }
}

// A ramp of one step over 512 pixels must not show as an edge: averages over blocks follow it.
TEST(ImageDither, SlowRampsDoNotBand) {
  constexpr std::uint32_t kBlock = 16;
  for (std::uint32_t block = 0; block < 32; ++block) {
    double sum = 0.0;
    double exact = 0.0;
    for (std::uint32_t y = 0; y < kBlock; ++y) {
      for (std::uint32_t x = block * kBlock; x < (block + 1) * kBlock; ++x) {
        const double steps = 100.0 + static_cast<double>(x) / 512.0;
        sum += quantize(static_cast<float>(steps / 255.0), x, y, 0, true);
        exact += steps;
      }
    }
    EXPECT_NEAR(sum / (kBlock * kBlock), exact / (kBlock * kBlock), 0.06) << block;
  }
}

TEST(ImageDither, OffIsRounding) {
  EXPECT_EQ(quantize(100.4F / 255.0F, 5, 9, 1, false), 100);
  EXPECT_EQ(quantize(100.6F / 255.0F, 5, 9, 1, false), 101);
}

}  // namespace
}  // namespace tyndall::image
