// Every tone-mapping operator against its published formula, implemented here in double precision, and against general
// requirements: black stays black, the white point becomes white, more light is never darker, and no possible input
// gives NaN.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "tyndall/post_settings.hpp"

namespace tyndall::post {
namespace {

using Rgb = std::array<double, 3>;

double luminance_of(const Rgb& c) { return 0.212671 * c[0] + 0.715160 * c[1] + 0.072169 * c[2]; }

double limited(double x) { return std::min(std::max(x, 0.0), 1.0); }

TonemapSettings with(Operator op, float white_point = 3.0F, float saturation = 1.0F) {
  TonemapSettings out;
  out.op = op;
  out.white_point = white_point;
  out.saturation = saturation;
  return out;
}

double grey(const TonemapSettings& settings, double scaled) {
  return tonemapped(settings, 1.0, {scaled, scaled, scaled})[1];
}

// Returns the test colours: dark to far beyond white, grey to saturated.
std::vector<Rgb> colours() {
  std::vector<Rgb> out;
  for (double scale = 1e-5; scale < 1e5; scale *= 2.3) {
    for (const Rgb& c : {Rgb{1, 1, 1}, Rgb{1, 0, 0}, Rgb{0, 0, 1}, Rgb{0.9, 0.5, 0.2}, Rgb{0.2, 0.4, 0.9}}) {
      out.push_back({scale * c[0], scale * c[1], scale * c[2]});
    }
  }
  return out;
}

// Tests an operator on luminance: `curve` is a function of L and the white point; colours are raised to the power of
// the saturation.
void expect_on_luminance(Operator op, const std::function<double(double, double)>& curve) {
  for (const float white_point : {0.5F, 3.0F, 20.0F}) {
    for (const float saturation : {0.3F, 1.0F, 1.7F}) {
      for (const Rgb& c : colours()) {
        const double l = luminance_of(c);
        const Rgb got = tonemapped(with(op, white_point, saturation), 1.0, c);
        for (std::size_t i = 0; i < 3; ++i) {
          const double expected =
              curve(l, static_cast<double>(white_point)) * std::pow(c[i] / l, static_cast<double>(saturation));
          ASSERT_NEAR(got[i], limited(expected), 1e-12) << l << " " << white_point << " " << saturation;
        }
      }
    }
  }
}

// Tests an operator on channels, which ignores the saturation and, unless it has one, the white point.
void expect_on_channels(Operator op, const std::function<double(double, double)>& curve) {
  for (const float white_point : {0.5F, 3.0F, 20.0F}) {
    for (const Rgb& c : colours()) {
      const Rgb got = tonemapped(with(op, white_point, 0.5F), 1.0, c);
      for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_NEAR(got[i], limited(curve(c[i], static_cast<double>(white_point))), 1e-12)
            << c[i] << " " << white_point;
      }
    }
  }
}

TEST(PostCurves, Exponential) {
  expect_on_luminance(Operator::exponential, [](double l, double) { return -std::expm1(-l); });
}

// O'Neil (2005): 1 - exp(-fExposure * color).
TEST(PostCurves, ExponentialOfChannels) {
  expect_on_channels(Operator::exponential_channels, [](double x, double) { return -std::expm1(-x); });
}

TEST(PostCurves, Reinhard) {
  expect_on_luminance(Operator::reinhard, [](double l, double) { return 1.0 - 1.0 / (1.0 + l); });
}

// Reinhard, Stark, Shirley and Ferwerda (2002), eq. 4.
TEST(PostCurves, ReinhardModified) {
  expect_on_luminance(Operator::reinhard_modified,
                      [](double l, double w) { return (l + (l / w) * (l / w)) / (1.0 + l); });
}

TEST(PostCurves, Logarithmic) {
  expect_on_luminance(Operator::logarithmic, [](double l, double w) { return std::log1p(l) / std::log1p(w); });
}

// Drago et al. (2003), eq. 4: Ldmax * 0.01 = 1, Lwmax the white point, b = 0.85.
TEST(PostCurves, AdaptiveLogarithmic) {
  expect_on_luminance(Operator::adaptive_logarithmic, [](double l, double w) {
    const double power = std::log(0.85) / std::log(0.5);
    return 1.0 / std::log10(w + 1.0) * std::log(l + 1.0) / std::log(2.0 + std::pow(l / w, power) * 8.0);
  });
}

// Hable (2010): a quotient of two quadratic functions, minus its value at 0.
TEST(PostCurves, Uncharted2) {
  const auto hable = [](double x) {
    const double at_0 = 0.2 * 0.02 / (0.2 * 0.3);
    return (0.15 * x * x + 0.05 * x + 0.004) / (0.15 * x * x + 0.5 * x + 0.06) - at_0;
  };
  expect_on_channels(Operator::uncharted2, [&](double x, double w) { return hable(2.0 * x) / hable(w); });
}

TEST(PostCurves, FilmicAlu) {
  expect_on_channels(Operator::filmic_alu, [](double c, double) {
    const double x = std::max(0.0, c - 0.004);
    return std::pow((6.2 * x * x + 0.5 * x) / (6.2 * x * x + 1.7 * x + 0.06), 2.2);
  });
}

// The polynomial approximates the sigmoid of Sobotka's AgX: through (10/16.5, 0.5) with slope 2 and powers 3 and 3.25
// below and above; 16.5 stops, 10 of them below 0.18. It deviates by up to 0.006 of the encoded value.
TEST(PostCurves, AgxFollowsTheSigmoidOfItsAuthor) {
  const double pivot = 10.0 / 16.5;
  const auto sigmoid = [&](double x) {
    const bool toe = x < pivot;
    const double power = toe ? 3.0 : 3.25;
    const double run = 2.0 * (toe ? pivot : 1.0 - pivot);
    const double scale = std::pow(std::pow(run, -power) * (std::pow(run / 0.5, power) - 1.0), -1.0 / power);
    const double t = 2.0 * std::abs(x - pivot) / scale;
    return 0.5 + (toe ? -1.0 : 1.0) * scale * t / std::pow(1.0 + std::pow(t, power), 1.0 / power);
  };
  for (double stops = -9.9; stops < 6.4; stops += 0.1) {
    const double encoded = std::pow(grey(with(Operator::agx), 0.18 * std::exp2(stops)), 1.0 / 2.2);
    ASSERT_NEAR(encoded, sigmoid((stops + 10.0) / 16.5), 0.007) << stops;
  }
}

// The second matrix inverts the first. The rows of the published ones add up to 1 within 2e-4, which the power of 2.2
// turns into 5e-4 for grey.
TEST(PostCurves, AgxPreservesGreyAndHues) {
  constexpr double kGrey = 5e-4;
  for (const double x : {0.001, 0.18, 1.0, 10.0, 100.0}) {
    const Rgb mapped = tonemapped(with(Operator::agx), 1.0, {x, x, x});
    EXPECT_NEAR(mapped[0], mapped[1], kGrey);
    EXPECT_NEAR(mapped[2], mapped[1], kGrey);
    // Without saturation every colour is grey.
    const Rgb colour = tonemapped(with(Operator::agx, 3.0F, 1e-6F), 1.0, {x, 0.3 * x, 0.1 * x});
    EXPECT_NEAR(colour[0], colour[1], kGrey);
    EXPECT_NEAR(colour[2], colour[1], kGrey);
    const Rgb more = tonemapped(with(Operator::agx, 3.0F, 1.4F), 1.0, {0.3, 0.2, 0.1});
    const Rgb less = tonemapped(with(Operator::agx, 3.0F, 0.6F), 1.0, {0.3, 0.2, 0.1});
    EXPECT_GT(more[0] - more[2], less[0] - less[2]);
  }
  // Very bright saturated colours become white, as on film.
  const Rgb red = tonemapped(with(Operator::agx), 1.0, {1e4, 0.0, 0.0});
  EXPECT_GT(red[1], 0.2);
}

// Khronos PBR Neutral: below 0.8, a colour loses 4 % of white, and less in the shadows. Above, its largest channel is
// compressed hyperbolically and it becomes white.
TEST(PostCurves, PbrNeutral) {
  constexpr double kMiddle = 0.18 / 0.3;  // its input is scaled so that middle grey is 0.3
  for (const Rgb& c : colours()) {
    Rgb x = {c[0] / kMiddle, c[1] / kMiddle, c[2] / kMiddle};
    const double low = std::min({x[0], x[1], x[2]});
    const double shift = low >= 0.08 ? 0.04 : low * (1.0 - 6.25 * low);
    for (double& value : x) value -= shift;
    const double p = std::max({x[0], x[1], x[2]});
    if (p >= 0.76) {
      const double p_new = 1.0 - 0.24 * 0.24 / (p - 0.52);
      const double g = 1.0 / (0.15 * (p - p_new) + 1.0);
      for (double& value : x) value = value * p_new / p * g + p_new * (1.0 - g);
    }
    const Rgb got = tonemapped(with(Operator::pbr_neutral), 1.0, c);
    for (std::size_t i = 0; i < 3; ++i) ASSERT_NEAR(got[i], limited(x[i]), 1e-12) << p;
  }
}

TEST(PostCurves, BlackStaysBlackAndMoreLightIsNotDarker) {
  for (std::uint32_t i = 0; i < kOperators; ++i) {
    for (const float white_point : {0.01F, 3.0F, 100.0F}) {
      const TonemapSettings settings = with(static_cast<Operator>(i), white_point);
      EXPECT_LT(grey(settings, 0.0), 1e-9) << i;
      double before = 0.0;
      for (double x = 1e-7; x < 1e12; x *= 1.05) {
        const double now = grey(settings, x);
        ASSERT_GE(now, before - 1e-12) << i << " at " << x;
        before = now;
      }
      // The polynomial of AgX ends at 0.9986 before the power of 2.2.
      EXPECT_GT(before, static_cast<Operator>(i) == Operator::agx ? 0.995 : 0.9999) << i;
    }
  }
}

TEST(PostCurves, TheWhitePointBecomesWhite) {
  for (const float white_point : {0.3F, 1.0F, 3.0F, 12.0F}) {
    const double w = static_cast<double>(white_point);
    for (const Operator op : {Operator::reinhard_modified, Operator::logarithmic, Operator::adaptive_logarithmic}) {
      EXPECT_NEAR(grey(with(op, white_point), w), 1.0, 1e-12);
      EXPECT_LT(grey(with(op, white_point), 0.95 * w), 1.0);
    }
    // Yusov (2013) doubles the input of this curve.
    EXPECT_NEAR(grey(with(Operator::uncharted2, white_point), 0.5 * w), 1.0, 1e-12);
    EXPECT_LT(grey(with(Operator::uncharted2, white_point), 0.45 * w), 1.0);
  }
}

TEST(PostCurves, ResultsAreNeverNan) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double values[] = {0.0, -0.0, -1.0, -inf, inf, nan, 1e-320, 1e-40, 1e-30, 1e300, 0.5};
  for (std::uint32_t i = 0; i < kOperators; ++i) {
    for (const float extreme : {0.01F, 2.0F, 100.0F}) {
      const TonemapSettings settings = with(static_cast<Operator>(i), extreme, std::min(extreme, 2.0F));
      for (const double r : values) {
        for (const double g : values) {
          for (const double exposure : {0.0, 1.8, 1e6}) {
            for (const double channel : tonemapped(settings, exposure, {r, g, 0.25})) {
              ASSERT_TRUE(channel >= 0.0 && channel <= 1.0) << i << " of " << r << " " << g << " " << exposure;
            }
          }
        }
      }
      // Negative values and NaN add nothing.
      EXPECT_EQ(tonemapped(settings, 1.0, {nan, -1.0, 0.25}), tonemapped(settings, 1.0, {0.0, 0.0, 0.25}));
    }
  }
}

}  // namespace
}  // namespace tyndall::post
