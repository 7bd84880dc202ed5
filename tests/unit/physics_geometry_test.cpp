// shaders/lib/geometry.glsl and the shadow cylinder in single precision against long double.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "models/glsl_double.hpp"
#include "physics_float.hpp"

namespace tyndall {
namespace {

using Real = long double;

constexpr float kRadius = 6.36e6F;
constexpr float kTop = 80000.0F;

struct Rng {
  std::mt19937 engine;
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
};

Real true_altitude_along(Real h0, Real mu, Real d, Real radius) {
  const Real r0 = radius + h0;
  return std::sqrt(r0 * r0 + 2.0L * r0 * mu * d + d * d) - radius;
}

TEST(physics_geometry, altitude_of_a_position_near_the_ground) {
  Rng rng{std::mt19937(1)};
  for (int i = 0; i < 20000; ++i) {
    const double reach = std::pow(10.0, rng(0.0, 6.0));
    const float x = static_cast<float>(rng(-reach, reach));
    const float z = static_cast<float>(rng(-reach, reach));
    const float y = static_cast<float>(rng(-500.0, 9000.0));
    const Real r = std::sqrt(Real(x) * x + Real(z) * z + (Real(y) + kRadius) * (Real(y) + kRadius));
    const Real expected = r - kRadius;
    // The tolerance is a few units in the last place of the summands.
    const double sum = (static_cast<double>(x) * x + static_cast<double>(z) * z) / (2.0 * kRadius) + std::abs(y);
    EXPECT_NEAR(glsl32::altitude_of(x, y, z, kRadius), static_cast<double>(expected), 6.0e-7 * sum + 1.0e-6);
  }
}

TEST(physics_geometry, altitude_along_rays) {
  Rng rng{std::mt19937(2)};
  double worst = 0.0;
  for (int i = 0; i < 50000; ++i) {
    const float h0 = static_cast<float>(rng(0.0, 1.0) < 0.3 ? 0.0 : rng(0.0, kTop));
    const float mu = static_cast<float>(i % 2 == 0 ? rng(-1.0, 1.0) : rng(-0.16, 0.16));
    const float d = static_cast<float>(std::pow(10.0, rng(0.0, 6.0)));
    const Real expected = true_altitude_along(h0, mu, d, kRadius);
    if (expected < -1.0 || expected > kTop) {
      continue;
    }
    worst = std::max(worst, std::abs(glsl32::altitude_along(h0, mu, d, kRadius) - static_cast<double>(expected)));
  }
  EXPECT_LT(worst, 0.15);  // the aerosol's scale height is 1200 m
}

TEST(physics_geometry, distance_to_the_top_and_back) {
  Rng rng{std::mt19937(3)};
  for (int i = 0; i < 20000; ++i) {
    const float h0 = static_cast<float>(kTop * (1.0 - std::pow(10.0, rng(-6.0, 0.0))));
    const float mu = static_cast<float>(rng(0.0, 1.0));
    const Real r0 = Real(kRadius) + h0;
    const Real rise = (Real(kTop) - h0) * (2.0L * kRadius + h0 + kTop);
    const Real expected = rise / (r0 * mu + std::sqrt(r0 * mu * r0 * mu + rise));
    EXPECT_NEAR(glsl32::distance_to_top(h0, mu, kTop, kRadius) / static_cast<double>(expected), 1.0, 2.0e-6)
        << h0 << ' ' << mu;
  }
}

TEST(physics_geometry, horizon) {
  for (const double h : {0.0, 0.01, 1.7, 100.0, 8000.0, 80000.0, 4.0e5, 3.6e7}) {
    const float altitude = static_cast<float>(h);
    const Real expected = -std::sqrt(Real(altitude) * (2.0L * kRadius + altitude)) / (Real(kRadius) + altitude);
    EXPECT_NEAR(glsl32::horizon_cos(altitude, kRadius), static_cast<double>(expected),
                2.0e-7 * std::abs(static_cast<double>(expected)));
  }
  EXPECT_EQ(glsl32::horizon_cos(-100.0F, kRadius), 0.0F);
  EXPECT_FALSE(glsl32::ray_hits_ground(0.0F, 0.0F, kRadius));
  EXPECT_TRUE(glsl32::ray_hits_ground(0.0F, -1.0e-7F, kRadius));
}

TEST(physics_geometry, segments_of_particular_rays) {
  float start = -1.0F;
  float end = -1.0F;
  bool ground = false;
  // Rays straight up and straight down.
  EXPECT_TRUE(glsl32::atmosphere_segment(0.0F, 1.0F, kTop, kRadius, start, end, ground));
  EXPECT_EQ(start, 0.0F);
  EXPECT_NEAR(end, 80000.0F, 0.1F);
  EXPECT_FALSE(ground);
  EXPECT_TRUE(glsl32::atmosphere_segment(5000.0F, -1.0F, kTop, kRadius, start, end, ground));
  EXPECT_NEAR(end, 5000.0F, 0.1F);
  EXPECT_TRUE(ground);
  // Rays from space go down through the whole atmosphere, past it, or away from it.
  EXPECT_TRUE(glsl32::atmosphere_segment(1.0e6F, -1.0F, kTop, kRadius, start, end, ground));
  EXPECT_NEAR(start, 920000.0F, 1.0F);
  EXPECT_NEAR(end, 1.0e6F, 1.0F);
  EXPECT_TRUE(ground);
  EXPECT_FALSE(glsl32::atmosphere_segment(1.0e6F, -0.1F, kTop, kRadius, start, end, ground));
  EXPECT_FALSE(glsl32::atmosphere_segment(1.0e6F, 1.0F, kTop, kRadius, start, end, ground));
  EXPECT_EQ(start, 0.0F);
  EXPECT_EQ(end, 0.0F);
  // From the ground, a downward ray has length 0, and a level ray reaches the sky.
  EXPECT_FALSE(glsl32::atmosphere_segment(0.0F, -0.5F, kTop, kRadius, start, end, ground));
  EXPECT_TRUE(ground);
  EXPECT_TRUE(glsl32::atmosphere_segment(0.0F, 0.0F, kTop, kRadius, start, end, ground));
  EXPECT_NEAR(end, 1.01193e6F, 20.0F);
  // For an eye below sea level, the ground is at twice its depth. Level rays miss the ground, and so do rays above its
  // horizon.
  EXPECT_TRUE(glsl32::atmosphere_segment(-300.0F, 0.01F, kTop, kRadius, start, end, ground));
  EXPECT_FALSE(ground);
  EXPECT_TRUE(glsl32::atmosphere_segment(-300.0F, -0.009F, kTop, kRadius, start, end, ground));
  EXPECT_FALSE(ground);
  EXPECT_GT(end, 1.0e6F);
  EXPECT_TRUE(glsl32::atmosphere_segment(-300.0F, -0.01F, kTop, kRadius, start, end, ground));
  EXPECT_TRUE(ground);
  EXPECT_NEAR(static_cast<double>(true_altitude_along(-300.0F, -0.01F, end, kRadius)), -600.0, 0.1);
}

// The altitude of the ground sphere has no step at sea level, and its horizon has none between -500 m and 500 m.
TEST(physics_geometry, the_ground_below_sea_level_begins_at_sea_level) {
  for (const double h : {-1.0e-3, -0.5, -20.0, -500.0, -11000.0}) {
    const float altitude = static_cast<float>(h);
    EXPECT_EQ(glsl32::ground_below(altitude, kRadius), 2.0F * altitude);
    const double r = 1.0 * kRadius + altitude;
    const double ground = 1.0 * kRadius + 2.0 * altitude;
    const double expected = -std::sqrt((r - ground) * (r + ground)) / r;
    EXPECT_NEAR(glsl32::ground_horizon_cos(altitude, kRadius), expected, 1.0e-6 * std::abs(expected));
    float start = 0.0F;
    float end = 0.0F;
    bool on_ground = false;
    EXPECT_TRUE(glsl32::atmosphere_segment(altitude, -1.0F, kTop, kRadius, start, end, on_ground));
    EXPECT_TRUE(on_ground);
    EXPECT_NEAR(end, -altitude, 1.0e-6 * std::abs(h));
  }
  for (const float h : {0.0F, 2.0F, 8000.0F}) {
    EXPECT_EQ(glsl32::ground_below(h, kRadius), 0.0F);
    EXPECT_EQ(glsl32::ground_horizon_cos(h, kRadius), glsl32::horizon_cos(h, kRadius));
  }
}

TEST(physics_geometry, segments_end_on_their_shells) {
  Rng rng{std::mt19937(4)};
  for (int i = 0; i < 20000; ++i) {
    const float h0 = static_cast<float>(i % 2 == 0 ? rng(0.0, kTop) : kTop + std::pow(10.0, rng(0.0, 7.0)));
    const double sine = rng(0.0, 1.0) * std::min(1.0, (kRadius + 1.0 * kTop) / (1.0 * kRadius + h0));
    const float mu = static_cast<float>(-std::sqrt(1.0 - sine * sine));
    float start = 0.0F;
    float end = 0.0F;
    bool ground = false;
    if (!glsl32::atmosphere_segment(h0, mu, kTop, kRadius, start, end, ground)) {
      continue;
    }
    const double reached = static_cast<double>(true_altitude_along(h0, mu, end, kRadius));
    // Positions are rounded to half a unit in the last place of a distance.
    const double rounding = 2.0e-7 * (std::abs(end) + h0) + 0.1;
    EXPECT_NEAR(reached, ground ? 0.0 : kTop, rounding) << h0 << ' ' << mu;
    if (h0 > kTop) {
      EXPECT_NEAR(static_cast<double>(true_altitude_along(h0, mu, start, kRadius)), kTop, rounding);
    }
  }
}

// The ends of the shadow lie on the cylinder behind the planet: the sun ray from there grazes sea level.
TEST(physics_geometry, shadow_ends_where_the_sun_ray_grazes_the_ground) {
  Rng rng{std::mt19937(5)};
  int ends = 0;
  double worst = 0.0;
  for (int i = 0; i < 50000; ++i) {
    const float h0 = static_cast<float>(rng(0.0, kTop));
    const float mu = static_cast<float>(rng(-0.3, 1.0));
    const float mu_s = static_cast<float>(std::cos(rng(80.0, 105.0) * std::numbers::pi / 180.0));
    const double sines = std::sqrt((1.0 - 1.0 * mu * mu) * (1.0 - 1.0 * mu_s * mu_s));
    const float nu = static_cast<float>(1.0 * mu * mu_s + sines * std::cos(rng(0.0, std::numbers::pi)));
    float start = 0.0F;
    float end = 0.0F;
    if (!glsl32::shadow_segment(h0, mu, mu_s, nu, kRadius, start, end)) {
      continue;
    }
    for (const float d : {start, end}) {
      const Real z = (Real(kRadius) + h0) * mu_s + Real(d) * nu;
      const Real h = true_altitude_along(h0, mu, d, kRadius);
      if (d <= 0.0F || h < 0.0L || h > kTop || std::abs(z) < 10.0L) {
        continue;  // behind the camera, outside the atmosphere, or on the plane through the terminator
      }
      const Real r = Real(kRadius) + h;
      worst = std::max(worst, std::abs(static_cast<double>(std::sqrt(r * r - z * z) - kRadius)));
      ++ends;
    }
  }
  EXPECT_GT(ends, 5000);
  EXPECT_LT(worst, 2.0);  // metres of altitude of the sun ray
}

TEST(physics_geometry, sun_disc_crosses_the_horizon) {
  const float radius = 0.004655F;
  for (const float h : {0.0F, 1000.0F, 50000.0F}) {
    const double horizon = std::acos(static_cast<double>(glsl32::horizon_cos(h, kRadius)));
    const auto visible = [&](double elevation) {
      return glsl32::sun_disc_visibility(h, static_cast<float>(std::cos(horizon - elevation)), kRadius, radius);
    };
    EXPECT_NEAR(visible(0.0), 0.5, 1.0e-3);
    EXPECT_EQ(visible(1.02 * radius), 1.0F);
    EXPECT_EQ(visible(-1.02 * radius), 0.0F);
    EXPECT_NEAR(visible(0.5 * radius), 0.80450, 2.0e-3);  // 1/2 + (x sqrt(1 - x^2) + asin x) / pi
  }
}

}  // namespace
}  // namespace tyndall
