// The closed-form density integrals of shaders/lib/optical_depth.glsl, in double and in single precision, against
// adaptive quadrature along thousands of rays above the ground: optical depth within 0.1 %.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "effect/medium.hpp"
#include "models/glsl_double.hpp"
#include "physics_float.hpp"
#include "physics_quadrature.hpp"

namespace tyndall {
namespace {

constexpr double kTolerance = 1.0e-3;

struct Query {
  double h, mu, d;
};

// Returns rays that the planet does not hide: from the ground, from anywhere in the atmosphere and from just below the
// top, in all directions and near the horizon; to the top, and over fractions of the way down to a ten-thousandth.
std::vector<Query> queries(const shared::Medium& m, int count) {
  std::mt19937 engine(5);
  const auto uniform = [&engine](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  const double radius = m.planet_radius_m;
  const double top = m.atmosphere_height_m;
  std::vector<Query> out;
  for (int i = 0; static_cast<int>(out.size()) < count; ++i) {
    double h = 0.0;
    switch (i % 5) {
      case 0: h = top * uniform(0.0, 1.0); break;
      case 1: h = top * std::pow(uniform(0.0, 1.0), 4.0); break;
      case 2: h = top * (1.0 - 0.1 * std::pow(uniform(0.0, 1.0), 4.0)) - 1.0; break;
      case 3: h = top * 0.99875; break;  // 79.9 km on Earth
      default: h = 0.0;
    }
    h = static_cast<float>(h);
    const double horizon = -std::sqrt(h * (2.0 * radius + h)) / (radius + h);
    double mu = 1.0;
    switch (i / 5 % 5) {
      case 0: mu = uniform(horizon, 1.0); break;
      case 1: mu = horizon + std::pow(10.0, uniform(-7.0, 0.0)); break;
      case 2: mu = uniform(0.0, 1.0e-3); break;
      case 3: mu = uniform(horizon, -horizon); break;
      default: mu = 1.0 - uniform(0.0, 1.0e-5);
    }
    mu = static_cast<float>(std::min(mu, 1.0));
    if (mu < horizon) {
      continue;
    }
    const double far = brute::far_crossing(m, h, mu, top);
    double d = 2.0 * far;
    if (i / 25 % 3 == 1) {
      d = far * std::pow(10.0, uniform(-4.0, 0.0));
    } else if (i / 25 % 3 == 2) {
      d = far * uniform(0.0, 1.0);
    }
    out.push_back({h, mu, static_cast<float>(d)});
  }
  return out;
}

void expect_columns(const shared::Medium& m, double tolerance, const char* name) {
  const glsl64::Medium wide = glsl64::widen(m);
  double worst_double = 0.0;
  double worst_float = 0.0;
  double worst_species = 0.0;
  Query at_double = {};
  Query at_float = {};
  for (const Query& q : queries(m, 6000)) {
    const double far = brute::far_crossing(m, q.h, q.mu, m.atmosphere_height_m);
    const brute::Three expected = brute::column(m, q.h, q.mu, std::min(q.d, far));
    const glsl64::vec3 in_double = glsl64::density_integral_along(wide, q.h, q.mu, q.d);
    const glsl32::Column in_float =
        glsl32::density_integral_along(m, static_cast<float>(q.h), static_cast<float>(q.mu), static_cast<float>(q.d));
    const brute::Three tau = brute::optical_depth(m, expected);
    const brute::Three tau_double = brute::optical_depth(m, {in_double.x, in_double.y, in_double.z});
    const brute::Three tau_float = brute::optical_depth(m, {in_float[0], in_float[1], in_float[2]});
    for (int c = 0; c < 3; ++c) {
      const double error_double = std::abs(tau_double[c] / tau[c] - 1.0);
      const double error_float = std::abs(tau_float[c] / tau[c] - 1.0);
      if (!(error_double <= worst_double)) {
        worst_double = error_double;
        at_double = q;
      }
      if (!(error_float <= worst_float)) {
        worst_float = error_float;
        at_float = q;
      }
    }
    for (int species = 0; species < 2; ++species) {
      if (expected[species] > 1.0e-20 * far) {
        worst_species = std::max(worst_species, std::abs(in_float[species] / expected[species] - 1.0));
      }
    }
  }
  EXPECT_LE(worst_double, tolerance) << name << " in double: h " << at_double.h << " mu " << at_double.mu << " d "
                                     << at_double.d;
  EXPECT_LE(worst_float, tolerance) << name << " in float: h " << at_float.h << " mu " << at_float.mu << " d "
                                    << at_float.d;
  EXPECT_LE(worst_species, kTolerance) << name << ": Rayleigh or aerosol alone, in float";
  ::testing::Test::RecordProperty(std::string(name) + "_double", std::to_string(worst_double));
  ::testing::Test::RecordProperty(std::string(name) + "_float", std::to_string(worst_float));
}

TEST(physics_columns, earth) { expect_columns(medium_from_params({}), 1.0e-4, "earth"); }

TEST(physics_columns, ozone_alone) {
  Params params;
  params.atmosphere.custom_coefficients = true;
  params.atmosphere.rayleigh_scattering = Vec3(1.0e-9F);
  params.atmosphere.aerosol_density = 0.0F;
  expect_columns(medium_from_params(params), kTolerance, "ozone");
}

TEST(physics_columns, other_planets) {
  Params small;
  small.planet.radius_m = 1.0e6F;
  small.atmosphere.height_m = 200000.0F;
  small.atmosphere.rayleigh_scale_height_m = 20000.0F;
  small.atmosphere.mie_scale_height_m = 5000.0F;
  small.atmosphere.ozone_centre_m = 50000.0F;
  small.atmosphere.ozone_half_width_m = 40000.0F;
  expect_columns(medium_from_params(small), kTolerance, "small and deep");

  Params large;
  large.planet.radius_m = 7.0e7F;
  large.atmosphere.height_m = 200000.0F;
  large.atmosphere.rayleigh_scale_height_m = 20000.0F;
  large.atmosphere.mie_scale_height_m = 500.0F;
  expect_columns(medium_from_params(large), kTolerance, "large");

  Params thin;
  thin.planet.radius_m = 1.0e6F;
  thin.atmosphere.height_m = 20000.0F;
  thin.atmosphere.rayleigh_scale_height_m = 500.0F;
  thin.atmosphere.mie_scale_height_m = 2000.0F;
  thin.atmosphere.ozone_centre_m = 5000.0F;
  thin.atmosphere.ozone_half_width_m = 4000.0F;
  expect_columns(medium_from_params(thin), kTolerance, "thin");
}

// The errors of vertical columns that docs/air.md states for high atmospheres, from which a note is printed.
TEST(physics_columns, high_atmospheres) {
  struct Case {
    float radius_m;
    double error;
  };
  for (const auto& [radius_m, error] : {Case{50000.0F, 0.003}, Case{10000.0F, 0.051}, Case{1000.0F, 0.61}}) {
    Params params;
    params.planet.radius_m = radius_m;
    params.atmosphere.rayleigh_scale_height_m = 8000.0F;
    const shared::Medium m = medium_from_params(params);
    const double column = glsl64::density_integral_to_top(glsl64::widen(m), 0.0, 1.0).x;
    const double truth = 8000.0 * (1.0 - std::exp(-static_cast<double>(m.atmosphere_height_m) / 8000.0));
    EXPECT_NEAR(column / truth - 1.0, error, 0.1 * error) << radius_m;
  }
}

TEST(physics_columns, from_space) {
  const shared::Medium m = medium_from_params({});
  const glsl64::Medium wide = glsl64::widen(m);
  for (const double h : {80001.0, 1.0e5, 4.0e5, 1.0e6, 1.0e7}) {
    for (const double perigee : {500.0, 5000.0, 30000.0, 70000.0}) {
      const double r = m.planet_radius_m + h;
      const double sine = (m.planet_radius_m + perigee) / r;
      const double mu = -std::sqrt((1.0 - sine) * (1.0 + sine));
      const double near = brute::near_crossing(m, h, mu, m.atmosphere_height_m);
      const double far = brute::far_crossing(m, h, mu, m.atmosphere_height_m);
      const brute::Three until_near = brute::column(m, h, mu, near);
      const brute::Three expected = brute::column(m, h, mu, far);
      EXPECT_LT(until_near[0], 1.0e-6 * expected[0]);
      const glsl64::vec3 column = glsl64::density_integral_to_top(wide, h, mu);
      EXPECT_NEAR(column.x / expected[0], 1.0, 1.0e-5) << h << ' ' << perigee;
      EXPECT_NEAR(column.y / expected[1], 1.0, 1.0e-5) << h << ' ' << perigee;
    }
    EXPECT_EQ(glsl64::density_integral_to_top(wide, h, 1.0).x, 0.0);
    EXPECT_EQ(glsl64::density_integral_along(wide, h, -1.0, h - m.atmosphere_height_m - 0.5).x, 0.0);
  }
}

// Below the horizon the result may be any large number, but must be finite: it is multiplied by zero.
TEST(physics_columns, occluded_rays_stay_finite) {
  const shared::Medium m = medium_from_params({});
  for (const float h : {-400.0F, 0.0F, 1000.0F, 79000.0F, 1.0e6F}) {
    for (float mu = -1.0F; mu < 0.1F; mu += 0.003F) {
      for (const float value : glsl32::density_integral_to_top(m, h, mu)) {
        ASSERT_TRUE(std::isfinite(value)) << h << ' ' << mu;
        ASSERT_GE(value, 0.0F);
      }
    }
  }
}

// A ray along the horizon ends on the ground at its perigee, where the distance from the perigee is 0 exactly.
TEST(physics_columns, rays_may_end_at_their_perigee) {
  const shared::Medium m = medium_from_params({});
  const glsl64::Medium wide = glsl64::widen(m);
  const double radius = m.planet_radius_m;
  for (const float h : {16.0F, 1000.0F, 3686.5793F, 8901.3333F, 35557.332F, 60000.0F, 79984.0F}) {
    const float mu = static_cast<float>(glsl64::ground_horizon_cos(h, radius));
    const float d = -(m.planet_radius_m + h) * mu;
    const double d64 = -(radius + h) * static_cast<double>(mu);
    const glsl64::vec3 before = glsl64::density_integral_along(wide, h, mu, 0.999 * d64);
    const glsl64::vec3 in_double = glsl64::density_integral_along(wide, h, mu, d64);
    const glsl32::Column in_single = glsl32::density_integral_along(m, h, mu, d);
    EXPECT_GT(in_double.x, before.x) << h;
    EXPECT_LT(in_double.x, 1.05 * before.x) << h;
    EXPECT_NEAR(static_cast<double>(in_single[0]), in_double.x, kTolerance * in_double.x) << h;
    EXPECT_NEAR(static_cast<double>(in_single[1]), in_double.y, kTolerance * in_double.y) << h;
    EXPECT_NEAR(static_cast<double>(in_single[2]), in_double.z, kTolerance * in_double.z + 1.0) << h;
  }
}

TEST(physics_columns, transmittance_is_multiplicative) {
  const glsl64::Medium m = glsl64::widen(medium_from_params({}));
  for (const double mu : {-0.04, 0.0, 0.02, 0.5}) {
    const double h = 10000.0;
    const double split = 70000.0;
    const glsl64::vec3 whole = glsl64::density_integral_along(m, h, mu, 200000.0);
    const glsl64::vec3 first = glsl64::density_integral_along(m, h, mu, split);
    const glsl64::vec3 second =
        glsl64::density_integral_along(m, glsl64::altitude_along(h, mu, split, m.planet_radius_m),
                                       glsl64::cos_zenith_along(h, mu, split, m.planet_radius_m), 200000.0 - split);
    const glsl64::vec3 a = glsl64::transmittance(m, whole);
    const glsl64::vec3 b = glsl64::transmittance(m, first) * glsl64::transmittance(m, second);
    EXPECT_NEAR(b.x / a.x, 1.0, 2.0e-5);
    EXPECT_NEAR(b.z / a.z, 1.0, 2.0e-5);
  }
}

}  // namespace
}  // namespace tyndall
