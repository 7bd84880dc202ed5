// The path tracer on a spherical planet: single scattering against quadrature, second order against brute force, ozone,
// rays from space, the visible ground.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "reference/path_tracer.hpp"
#include "reference_oracle.hpp"

namespace {

using tyndall::Params;
using tyndall::Vec3;
using namespace tyndall::reference;
using tyndall::RayQuery;

constexpr double kDegree = std::numbers::pi / 180.0;

RayQuery ray(double altitude_m, double view_deg, double sun_deg, double azimuth_deg) {
  return {altitude_m, view_deg * kDegree, sun_deg * kDegree, azimuth_deg * kDegree, false};
}
RayQuery sky(double altitude_m, double sun_deg) { return {altitude_m, 0.0, sun_deg * kDegree, 0.0, true}; }

std::vector<Estimate> run(const Params& p, const std::vector<RayQuery>& queries, std::uint64_t samples, int orders,
                          bool by_order = false, bool visible_ground = true) {
  Options options;
  options.samples = samples;
  options.orders = orders;
  options.by_order = by_order;
  options.threads = 2;
  options.visible_ground = visible_ground;
  const auto result = trace(p, queries, options);
  if (!result.ok()) {
    ADD_FAILURE() << result.error().message;
    return std::vector<Estimate>(queries.size());
  }
  return result.value();
}

// Returns the coefficients of the default atmosphere from their definition.
oracle::Air default_air(const Params& p, std::size_t channel) {
  const double wavelength_m[3] = {680e-9, 550e-9, 440e-9};
  const double n2_1 = 1.0003 * 1.0003 - 1.0;
  const double rayleigh = 8.0 * std::pow(oracle::kPi, 3) * n2_1 * n2_1 / (3.0 * 2.545e25) *
                          ((6.0 + 3.0 * 0.035) / (6.0 - 7.0 * 0.035)) / std::pow(wavelength_m[channel], 4);
  const Vec3& o = p.atmosphere.ozone_absorption;
  const float ozone[3] = {o.x, o.y, o.z};
  return oracle::air_of(p, rayleigh, 2e-5, 2.2e-5, ozone[channel]);
}

oracle::Point camera_of(const oracle::Air& air, const RayQuery& q) { return {0.0, 0.0, air.radius + q.altitude_m}; }
oracle::Point view_of(const RayQuery& q) { return {std::sin(q.view_zenith_rad), 0.0, std::cos(q.view_zenith_rad)}; }
oracle::Point sun_of(const RayQuery& q) {
  const double sine = std::sin(q.sun_zenith_rad);
  return {sine * std::cos(q.azimuth_rad), sine * std::sin(q.azimuth_rad), std::cos(q.sun_zenith_rad)};
}

TEST(ReferenceShell, SingleScatteringMatchesQuadrature) {
  const Params p;
  const std::vector<RayQuery> queries = {
      ray(0.0, 30.0, 40.0, 60.0),        // day
      ray(0.0, 89.0, 20.0, 120.0),       // along the horizon
      ray(1500.0, 93.0, 70.0, 10.0),     // downwards to the ground
      ray(10000.0, 91.0, 60.0, 5.0),     // through the tangent point, near the sun's azimuth
      ray(0.0, 85.0, 89.0, 1.0),         // at the setting sun
      ray(0.0, 60.0, 93.0, 30.0),        // twilight
      ray(0.0, 80.0, 95.0, 150.0),       // the dark side of twilight
      ray(40000.0, 95.0, 92.0, 60.0),    // into the shadow from above
      ray(300000.0, 106.0, 50.0, 40.0),  // from space
      ray(-400.0, 20.0, 50.0, 30.0),     // below sea level: upwards,
      ray(-400.0, 90.3, 70.0, 100.0),    // past the ground and up again,
      ray(-400.0, 92.0, 60.0, 20.0),     // and down to it
      ray(-400.0, 80.0, 93.0, 30.0),    ray(-2000.0, 70.0, 40.0, 90.0)};
  const auto estimates = run(p, queries, 65536, 1);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const oracle::Air air = default_air(p, c);
      oracle::Point from = camera_of(air, queries[i]);
      const oracle::Point view = view_of(queries[i]);
      if (queries[i].altitude_m > p.atmosphere.height_m) {  // move the eye to where the ray enters
        const double b = oracle::dot(from, view);
        from = oracle::along(from, view, -b - std::sqrt(b * b - oracle::dot(from, from) + air.top * air.top));
      }
      const double expected = oracle::single_scattering(air, from, view, sun_of(queries[i]), 250, 24);
      EXPECT_NEAR(estimates[i].radiance[c], expected, 4.0 * estimates[i].standard_error[c] + 3e-4 * expected)
          << "ray " << i << " channel " << c;
      EXPECT_LT(estimates[i].standard_error[c], 4e-3 * expected) << "ray " << i << " channel " << c;

      bool ground = false;
      const double reach = air.reach(from, view, ground, oracle::camera_ground(air, from));
      EXPECT_NEAR(estimates[i].transmittance[c], std::exp(-air.depth(from, view, reach, 2000)), 2e-6);
    }
  }
}

// The radiance of exactly two scattering events. Everything is sampled uniformly, which is slow, but simple enough to
// be trusted.
struct BruteForce {
  double mean = 0.0, error = 0.0;
};
BruteForce second_order(const oracle::Air& air, const RayQuery& q, int count) {
  std::mt19937_64 random(99);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const oracle::Point eye = camera_of(air, q), view = view_of(q), sun = sun_of(q);
  bool ground = false;
  const double reach = air.reach(eye, view, ground, oracle::camera_ground(air, eye));
  double sum = 0.0, square = 0.0;
  for (int i = 0; i < count; ++i) {
    const double u = uniform(random), t1 = reach * u * u;  // more of them near the eye
    const oracle::Point a = oracle::along(eye, view, t1);
    const double z = 2.0 * uniform(random) - 1.0, turn = 2.0 * oracle::kPi * uniform(random);
    const double side = std::sqrt(1.0 - z * z);
    const oracle::Point w = {side * std::cos(turn), side * std::sin(turn), z};
    const double reach2 = air.reach(a, w, ground, air.radius), v = uniform(random), t2 = reach2 * v * v;
    const oracle::Point b = oracle::along(a, w, t2);
    double value = air.sun_transmittance(b, sun, 6);
    if (value > 0.0) {
      value *= std::exp(-air.depth(eye, view, t1, 5) - air.depth(a, w, t2, 5));
      value *= air.rayleigh_at(air.height(a)) * 2.0 * reach * u * air.rayleigh_at(air.height(b)) * 2.0 * reach2 * v;
      value *= 4.0 * oracle::kPi * oracle::rayleigh_phase(oracle::dot(view, w)) *
               oracle::rayleigh_phase(oracle::dot(w, sun));
    }
    sum += value;
    square += value * value;
  }
  const double mean = sum / count;
  return {mean, std::sqrt((square / count - mean * mean) / count)};
}

TEST(ReferenceShell, SecondOrderMatchesBruteForce) {
  Params p;
  p.atmosphere.custom_coefficients = true;
  p.atmosphere.mie_scattering = p.atmosphere.mie_absorption = Vec3(0.0F);
  p.planet.radius_m = 500000.0F;  // a small planet: its shadow crosses many of these paths
  p.atmosphere.height_m = 60000.0F;
  const std::vector<RayQuery> queries = {ray(0.0, 40.0, 50.0, 100.0),    ray(2000.0, 80.0, 97.0, 20.0),
                                         ray(0.0, 60.0, 96.0, 170.0),    ray(20000.0, 100.0, 88.0, 60.0),
                                         ray(-3000.0, 80.0, 60.0, 90.0), ray(-3000.0, 120.0, 60.0, 90.0)};
  const auto estimates = run(p, queries, 200000, 2, true);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    for (const std::size_t c : {std::size_t{0}, std::size_t{2}}) {
      const double rayleigh = c == 0 ? p.atmosphere.rayleigh_scattering.x : p.atmosphere.rayleigh_scattering.z;
      const double ozone = c == 0 ? p.atmosphere.ozone_absorption.x : p.atmosphere.ozone_absorption.z;
      const BruteForce expected = second_order(oracle::air_of(p, rayleigh, 0.0, 0.0, ozone), queries[i], 100000);
      const double error = std::hypot(expected.error, estimates[i].order_standard_error[1][c]);
      EXPECT_NEAR(estimates[i].order_radiance[1][c], expected.mean, 4.0 * error) << "ray " << i << " channel " << c;
      EXPECT_LT(error, 0.04 * expected.mean) << "ray " << i << " channel " << c;
    }
  }
}

TEST(ReferenceShell, OzoneAloneOnlyAbsorbs) {
  Params p;
  p.atmosphere.custom_coefficients = true;
  p.atmosphere.rayleigh_scattering = p.atmosphere.mie_scattering = p.atmosphere.mie_absorption = Vec3(0.0F);
  const auto clear = run(p, {ray(0.0, 80.0, 30.0, 0.0), sky(0.0, 30.0)}, 1000, 4);
  const oracle::Air air = oracle::air_of(p, 0.0, 0.0, 0.0, p.atmosphere.ozone_absorption.y);
  const oracle::Point from = {0.0, 0.0, air.radius}, view = view_of(ray(0.0, 80.0, 0.0, 0.0));
  bool ground = false;
  EXPECT_NEAR(clear[0].transmittance[1],
              std::exp(-air.depth(from, view, air.reach(from, view, ground, air.radius), 4000)), 1e-7);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(clear[0].radiance[c], 0.0);
    EXPECT_EQ(clear[1].radiance[c], 0.0);
  }

  Params more, none;
  more.atmosphere.ozone_absorption = Vec3(5e-6F, 5e-6F, 5e-6F);
  none.atmosphere.ozone_absorption = Vec3(0.0F);
  const std::vector<RayQuery> queries = {ray(0.0, 70.0, 88.0, 90.0)};
  const auto with = run(more, queries, 20000, 4), without = run(none, queries, 20000, 4);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_LT(with[0].radiance[c], 0.9 * without[0].radiance[c]);
    EXPECT_LT(with[0].transmittance[c], without[0].transmittance[c]);
  }
}

TEST(ReferenceShell, RaysFromSpace) {
  Params p;
  p.planet.ground_albedo = tyndall::Vec3(0.3F);
  const double radius = p.planet.radius_m, top = radius + p.atmosphere.height_m;
  // Rays past the atmosphere, away from it, and outwards from its edge have no radiance and a transmittance of 1.
  const auto missed = run(p,
                          {ray(400000.0, 90.0, 30.0, 0.0), ray(400000.0, 10.0, 30.0, 0.0),
                           ray(80000.0, 60.0, 30.0, 0.0), sky(90000.0, 20.0)},
                          1000, 3);
  for (const Estimate& e : missed) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(e.radiance[c], 0.0);
      EXPECT_EQ(e.standard_error[c], 0.0);
      EXPECT_EQ(e.transmittance[c], 1.0);
    }
  }
  EXPECT_EQ(run(p, {sky(90000.0, 179.0)}, 1000, 3)[0].transmittance[1], 0.0);

  // The eye is at three points of the same ray: in space, at the edge of the atmosphere and just inside.
  const RayQuery far = ray(1000000.0, 150.0, 40.0, 70.0);
  const double r = radius + far.altitude_m, along = r * std::cos(far.view_zenith_rad);
  const double tangent2 = r * r - along * along;
  const double entry = -std::sqrt(top * top - tangent2);
  const auto from = [&](double s) {  // the camera at s on the line, in its own local frame
    const double z = std::sqrt(tangent2 + s * s), view_cosine = s / z;
    const double sun[3] = {std::sin(far.sun_zenith_rad) * std::cos(far.azimuth_rad),
                           std::sin(far.sun_zenith_rad) * std::sin(far.azimuth_rad), std::cos(far.sun_zenith_rad)};
    const double sine = std::sin(far.view_zenith_rad), cosine = std::cos(far.view_zenith_rad);
    const double x = sine * (s - along) / z, up = (r + cosine * (s - along)) / z;  // the local vertical
    const double sun_cosine = sun[0] * x + sun[2] * up;
    const double level = sun[0] * up - sun[2] * x;  // towards the ray's side
    return RayQuery{z - radius, std::acos(view_cosine), std::acos(sun_cosine), std::atan2(sun[1], level), false};
  };
  const auto same = run(p, {far, from(entry - 1.0), from(entry + 1e-3)}, 50000, 4);
  for (std::size_t i = 1; i < same.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double sigma = std::hypot(same[0].standard_error[c], same[i].standard_error[c]);
      EXPECT_NEAR(same[i].radiance[c], same[0].radiance[c], 4.0 * sigma);
      EXPECT_LT(sigma, 5e-3 * same[0].radiance[c]);
      EXPECT_NEAR(same[i].transmittance[c], same[0].transmittance[c], 1e-7);
    }
  }
}

TEST(ReferenceShell, VisibleGround) {
  Params p;
  p.planet.ground_albedo = tyndall::Vec3(0.4F);
  const std::vector<RayQuery> queries = {ray(3000.0, 130.0, 50.0, 30.0), ray(0.0, 60.0, 50.0, 30.0)};
  const auto with = run(p, queries, 50000, 4), without = run(p, queries, 50000, 4, false, false);
  // The light of the ground is that of sun and sky, reflected and attenuated.
  const auto below = run(p, {sky(0.0, 50.0)}, 50000, 3);
  for (std::size_t c = 0; c < 3; ++c) {
    const double lit = below[0].transmittance[c] * std::cos(50.0 * kDegree) + below[0].radiance[c];
    const double expected = 0.4 / oracle::kPi * lit * with[0].transmittance[c];
    // The sun is slightly lower or higher where the ray hits the ground, 3.6 km away.
    EXPECT_NEAR((with[0].radiance[c] - without[0].radiance[c]) / expected, 1.0, 6e-3);
    const double sigma = std::hypot(with[1].standard_error[c], without[1].standard_error[c]);
    EXPECT_NEAR(with[1].radiance[c], without[1].radiance[c], 4.0 * sigma);  // no ground there
  }
}

TEST(ReferenceShell, SkyIrradianceIsTheIntegralOfTheSky) {
  const Params p;
  const double sun_deg = 60.0, altitude_m = 500.0;
  // One ray at a random position in each of 40 x 40 cells: squares of the cosine, so that the cosine weight is in the
  // nodes, times azimuths.
  constexpr int kCells = 40;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<RayQuery> queries;
  for (int i = 0; i < kCells; ++i) {
    for (int k = 0; k < kCells; ++k) {
      const double mu = std::sqrt((i + uniform(random)) / kCells);
      queries.push_back(ray(altitude_m, std::acos(mu) / kDegree, sun_deg, 180.0 * (k + uniform(random)) / kCells));
    }
  }
  const auto rays = run(p, queries, 64, 5);
  const auto whole = run(p, {sky(altitude_m, sun_deg)}, 50000, 5);
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0.0;
    for (const Estimate& e : rays) sum += e.radiance[c] * oracle::kPi / static_cast<double>(rays.size());
    EXPECT_NEAR(whole[0].radiance[c], sum, 4.0 * whole[0].standard_error[c] + 5e-3 * sum);
  }
}

}  // namespace
