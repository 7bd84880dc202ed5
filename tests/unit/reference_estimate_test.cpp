// The properties of the path tracer's results: reproducibility, valid standard errors, orders, rejected input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "reference/path_tracer.hpp"

namespace {

using tyndall::ErrorCode;
using tyndall::Params;
using namespace tyndall::reference;
using tyndall::RayQuery;

constexpr double kDegree = std::numbers::pi / 180.0;

RayQuery ray(double altitude_m, double view_deg, double sun_deg, double azimuth_deg) {
  return {altitude_m, view_deg * kDegree, sun_deg * kDegree, azimuth_deg * kDegree, false};
}

std::vector<Estimate> run(const Params& p, const std::vector<RayQuery>& queries, const Options& options,
                          const Progress& progress = {}) {
  const auto result = trace(p, queries, options, progress);
  if (!result.ok()) {
    ADD_FAILURE() << result.error().message;
    return std::vector<Estimate>(queries.size());
  }
  return result.value();
}

bool same_bits(const Rgb& a, const Rgb& b) { return std::memcmp(a.data(), b.data(), sizeof(Rgb)) == 0; }

TEST(ReferenceEstimate, IndependentOfThreads) {
  Params p;
  p.planet.ground_albedo = tyndall::Vec3(0.2F);
  const std::vector<RayQuery> queries = {
      ray(0.0, 60.0, 40.0, 20.0), {100.0, 0.0, 80.0 * kDegree, 0.0, true}, ray(0.0, 80.0, 96.0, 100.0)};
  Options options;
  options.samples = 5000;
  options.by_order = true;
  options.threads = 1;
  const auto one = run(p, queries, options);
  options.threads = 5;
  const auto five = run(p, queries, options);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    EXPECT_TRUE(same_bits(one[i].radiance, five[i].radiance));
    EXPECT_TRUE(same_bits(one[i].standard_error, five[i].standard_error));
    for (std::size_t n = 0; n < 8; ++n) EXPECT_TRUE(same_bits(one[i].order_radiance[n], five[i].order_radiance[n]));
  }
  // A ray's random numbers depend on the seed, but not on the rays after it.
  EXPECT_TRUE(same_bits(run(p, {queries[0]}, options)[0].radiance, one[0].radiance));
  options.seed = 2;
  EXPECT_FALSE(same_bits(run(p, queries, options)[0].radiance, one[0].radiance));
}

TEST(ReferenceEstimate, PartsOfTheQueriesHaveTheSameEstimates) {
  const Params p;
  // The eye below sea level extends the atmosphere for all queries.
  const std::vector<RayQuery> queries = {ray(0.0, 60.0, 40.0, 20.0), ray(500.0, 30.0, 70.0, 20.0),
                                         ray(-300.0, 80.0, 60.0, 100.0), ray(9000.0, 95.0, 20.0, 10.0)};
  Options options;
  options.samples = 500;
  const auto whole = run(p, queries, options);
  for (const std::uint64_t stride : {2U, 3U, 7U}) {
    std::size_t count = 0;
    options.stride = stride;
    for (options.first = 0; options.first < stride; ++options.first) {
      const auto part = run(p, queries, options);
      for (std::size_t i = 0; i < part.size(); ++i, ++count) {
        EXPECT_TRUE(same_bits(part[i].radiance, whole[options.first + i * stride].radiance));
        EXPECT_TRUE(same_bits(part[i].transmittance, whole[options.first + i * stride].transmittance));
      }
    }
    EXPECT_EQ(count, queries.size());
  }
  EXPECT_EQ(traced_samples(500), whole[0].samples);
  options.stride = 0;
  EXPECT_FALSE(trace(p, queries, options).ok());
}

// Compares the spread of many independent estimates of one ray with their standard errors.
void expect_honest_errors(const RayQuery& query) {
  constexpr std::size_t kRepeats = 200;
  Options options;
  options.samples = 2048;
  options.orders = 5;
  options.threads = 2;
  const auto estimates = run(Params{}, std::vector<RayQuery>(kRepeats, query), options);
  for (std::size_t c = 0; c < 3; ++c) {
    double mean = 0.0, variance = 0.0, claimed = 0.0;
    for (const Estimate& e : estimates) {
      mean += e.radiance[c] / kRepeats;
      claimed += e.standard_error[c] * e.standard_error[c] / kRepeats;
    }
    for (const Estimate& e : estimates) variance += std::pow(e.radiance[c] - mean, 2) / (kRepeats - 1.0);
    // kRepeats * variance / claimed follows a chi-square distribution with 199 degrees of freedom, with a sigma of 10
    // %. The mean of the claimed variances adds little, except for heavy tails.
    EXPECT_NEAR(variance / claimed, 1.0, 0.4) << "channel " << c;
    int beyond = 0;
    for (const Estimate& e : estimates) beyond += std::abs(e.radiance[c] - mean) > 2.0 * e.standard_error[c] ? 1 : 0;
    EXPECT_LT(beyond, 28) << "channel " << c;  // 5 % of 200 are 10; a skewed distribution has more
  }
}
TEST(ReferenceEstimate, HonestErrorsByDay) { expect_honest_errors(ray(0.0, 70.0, 50.0, 60.0)); }
TEST(ReferenceEstimate, HonestErrorsAtSunset) { expect_honest_errors(ray(0.0, 60.0, 91.0, 20.0)); }
TEST(ReferenceEstimate, HonestErrorsOfTheSky) { expect_honest_errors({0.0, 0.0, 70.0 * kDegree, 0.0, true}); }

TEST(ReferenceEstimate, OrdersAddUp) {
  Params p;
  p.planet.ground_albedo = tyndall::Vec3(0.5F);
  const std::vector<RayQuery> queries = {ray(2000.0, 120.0, 30.0, 50.0), ray(0.0, 50.0, 70.0, 10.0)};
  Options options;
  options.samples = 20000;
  options.by_order = true;
  options.orders = 6;
  const auto six = run(p, queries, options);
  options.orders = 1;
  const auto one = run(p, queries, options);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    ASSERT_EQ(six[i].order_radiance.size(), 6U);
    ASSERT_EQ(one[i].order_radiance.size(), 1U);
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (const Rgb& order : six[i].order_radiance) sum += order[c];
      EXPECT_NEAR(sum, six[i].radiance[c], 1e-12 * sum);
      EXPECT_LT(six[i].order_radiance[5][c], six[i].order_radiance[2][c]);
      const double sigma = std::hypot(one[i].standard_error[c], six[i].order_standard_error[0][c]);
      EXPECT_NEAR(one[i].radiance[c], six[i].order_radiance[0][c], 4.0 * sigma);
      EXPECT_EQ(one[i].transmittance[c], six[i].transmittance[c]);
    }
  }
}

TEST(ReferenceEstimate, CountsItsSamples) {
  Options options;
  for (const std::uint64_t samples : {1ULL, 31ULL, 1000ULL, 200000ULL}) {
    options.samples = samples;
    options.orders = 1;
    const Estimate e = run(Params{}, {ray(0.0, 20.0, 30.0, 0.0)}, options)[0];
    EXPECT_GE(e.samples, samples);
    EXPECT_LE(e.samples, samples + samples / 32 + 1);
    EXPECT_EQ(std::isinf(e.standard_error[0]), samples == 1);
  }
}

TEST(ReferenceEstimate, ReportsProgressAndCancels) {
  Options options;
  options.samples = 20000;
  options.orders = 2;
  options.threads = 2;
  const std::vector<RayQuery> queries(3, ray(0.0, 20.0, 30.0, 0.0));
  double last = 0.0;
  const auto whole = run(Params{}, queries, options, [&](double done) {
    EXPECT_GT(done, last);
    last = done;
    return true;
  });
  EXPECT_DOUBLE_EQ(last, 1.0);
  const auto part = run(Params{}, queries, options, [](double done) { return done < 0.5; });
  EXPECT_EQ(part[0].samples, whole[0].samples);
  EXPECT_LT(part[2].samples, whole[2].samples);
}

TEST(ReferenceEstimate, RefusesBadInput) {
  const RayQuery good = ray(0.0, 20.0, 30.0, 0.0);
  const auto refused = [](const Params& p, const RayQuery& q, const Options& o, const char* about) {
    tyndall::Error error{ErrorCode::io, "accepted", 0};
    if (const auto result = trace(p, q, o); !result.ok()) error = result.error();
    EXPECT_EQ(error.code, ErrorCode::invalid_argument) << about;
    EXPECT_NE(error.message.find(about), std::string::npos) << error.message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Options few;
  few.samples = 100;
  refused({}, ray(-11001.0, 20.0, 30.0, 0.0), few, "altitude_m");
  refused({}, ray(nan, 20.0, 30.0, 0.0), few, "altitude_m");
  refused({}, ray(0.0, 181.0, 30.0, 0.0), few, "view_zenith_rad");
  refused({}, ray(0.0, 20.0, nan, 0.0), few, "sun_zenith_rad");
  refused({}, ray(0.0, 20.0, 30.0, nan), few, "azimuth_rad");
  Options bad = few;
  bad.samples = 0;
  refused({}, good, bad, "samples");
  bad = few;
  bad.orders = 0;
  refused({}, good, bad, "orders");
  bad = few;
  bad.threads = -1;
  refused({}, good, bad, "threads");
  Params p;
  p.atmosphere.mie_g = 1.0F;
  refused(p, good, few, "atmosphere.mie_g");
  p = {};
  p.atmosphere.mie_scattering.y = std::numeric_limits<float>::infinity();
  refused(p, good, few, "atmosphere.mie_scattering");
  EXPECT_TRUE(run({}, {}, few).empty());
}

// All parameters at the limits of their ranges: finite and not negative.
TEST(ReferenceEstimate, ExtremesStayFinite) {
  std::vector<Params> worlds(5);
  worlds[0].planet.radius_m = 1000.0F;
  worlds[0].atmosphere.height_m = 1e7F;
  worlds[1].planet.radius_m = 1e8F;
  worlds[1].atmosphere.height_m = 1000.0F;
  worlds[1].atmosphere.rayleigh_scale_height_m = worlds[1].atmosphere.mie_scale_height_m = 10.0F;
  worlds[2].atmosphere.aerosol_density = 100.0F;
  worlds[2].atmosphere.aerosol_absorption = 10.0F;
  worlds[2].atmosphere.mie_g = 0.99F;
  worlds[3].atmosphere.rayleigh_scale_height_m = worlds[3].atmosphere.mie_scale_height_m = 1e6F;
  worlds[3].planet.ground_albedo = tyndall::Vec3(1.0F);
  worlds[4].atmosphere.custom_coefficients = true;
  worlds[4].atmosphere.rayleigh_scattering = tyndall::Vec3(1.0F, 0.0F, 1e-12F);
  worlds[4].atmosphere.mie_scattering = worlds[4].atmosphere.mie_absorption = tyndall::Vec3(0.0F, 0.0F, 1.0F);
  std::vector<RayQuery> queries;
  for (const double altitude : {-11000.0, -400.0, 0.0, 100.0, 20000.0, 80000.0, 5e6, 1e9}) {
    for (const double view : {0.0, 45.0, 89.999, 90.0, 90.001, 120.0, 180.0}) {
      for (const double sun : {0.0, 90.0, 95.0, 180.0}) queries.push_back(ray(altitude, view, sun, view));
    }
    for (const double sun : {0.0, 90.0, 95.0, 180.0}) queries.push_back({altitude, 0.0, sun * kDegree, 0.0, true});
  }
  Options options;
  options.samples = 64;
  options.orders = 6;
  options.threads = 2;
  for (const Params& p : worlds) {
    std::vector<RayQuery> here = queries;
    for (RayQuery& q : here) q.altitude_m = std::max(q.altitude_m, -0.25 * static_cast<double>(p.planet.radius_m));
    const auto estimates = run(p, here, options);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isfinite(estimates[i].radiance[c])) << "query " << i;
        EXPECT_GE(estimates[i].radiance[c], 0.0) << "query " << i;
        EXPECT_TRUE(std::isfinite(estimates[i].standard_error[c])) << "query " << i;
        EXPECT_GE(estimates[i].transmittance[c], 0.0) << "query " << i;
        EXPECT_LE(estimates[i].transmittance[c], 1.0) << "query " << i;
      }
    }
  }
}

}  // namespace
