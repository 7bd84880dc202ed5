// Compares the light that the renderer reads from the scattering tables with the path tracer. The limits are those of
// docs/tables.md, plus an allowance for the noise of the few paths that are traced here.
#include <algorithm>
#include <cmath>

#include "effect/medium.hpp"
#include "gpu_test.hpp"
#include "models/precomputed.hpp"
#include "reference/path_tracer.hpp"
#include "table_rays.hpp"

namespace tyndall {
namespace {

// Errors of all channels of a set of rays, relative to the largest channel of the truth.
struct Errors {
  std::vector<double> all;
  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (const double error : all) sum += error;
    return sum / static_cast<double>(all.size());
  }
  [[nodiscard]] double percentile(double part) const {
    std::vector<double> sorted = all;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  }
};

std::vector<RayQuery> skies(std::initializer_list<double> elevations_deg) {
  std::vector<RayQuery> out;
  for (const double elevation : elevations_deg) {
    for (const double altitude : {-400.0, 0.0, 1500.0}) {
      RayQuery query;
      query.altitude_m = altitude;
      query.sun_zenith_rad = (90.0 - elevation) * kRadians;
      query.sky_irradiance = true;
      out.push_back(query);
    }
  }
  return out;
}

// Returns random rays from altitudes of down to -430 m, the shore of the Dead Sea.
std::vector<RayQuery> below_sea_level(int count) {
  std::vector<RayQuery> out = random_rays(13, count, 5.0, 90.0);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i].altitude_m = i % 2 == 0 ? -400.0 : -430.0 * out[i].azimuth_rad / kPi;
  return out;
}

// A ray near the horizon of a turbid atmosphere under a low sun. Its light has been scattered many times, and the
// tables estimate the last orders. The values are those of the path tracer, with standard errors of 0.1 to 0.5 % of a
// ray's largest channel:
//   tyndall probe --model reference --orders 24 --samples 150000 --seed 3 --queries RAYS.csv
//     --set atmosphere.aerosol_density=11.36 --set planet.ground_albedo=0.4,0.2,0.05
struct TurbidRay {
  double altitude_m, view_zenith_deg, sun_zenith_deg, azimuth_deg;
  double radiance[3];  // over the sun's irradiance [1/sr]
};
constexpr TurbidRay kTurbidRays[] = {
    {303.0, 85.6, 81.6, 11.0, {0.47912, 0.29052, 0.13192}},
    {200.0, 89.1, 83.6, 3.0, {0.28521, 0.15158, 0.056279}},
    {337.0, 86.8, 86.2, 22.0, {0.07931, 0.036915, 0.014612}},
    {615.0, 88.8, 80.5, 144.0, {0.019938, 0.019272, 0.020692}},
    {121.0, 86.9, 82.7, 150.0, {0.013932, 0.012963, 0.013526}},
    {427.0, 86.6, 83.8, 66.0, {0.025217, 0.018581, 0.014933}},
    {953.0, 86.5, 88.4, 133.0, {0.0069909, 0.0054397, 0.0051076}},
    {20.0, 89.3, 85.3, 172.0, {0.0074868, 0.0063597, 0.0066199}},
    {668.0, 87.3, 86.5, 72.0, {0.013228, 0.0093554, 0.0080396}},
    {461.0, 88.3, 84.8, 165.0, {0.01136, 0.010303, 0.010471}},
    {704.0, 86.2, 89.2, 104.0, {0.0042045, 0.0032351, 0.0034465}},
};

class ScatteringTablesTest : public GpuTest {
 protected:
  // Returns the errors of the model for some queries, against `samples` paths of eight orders each.
  static Errors errors(models::PrecomputedModel& model, const Params& params, const std::vector<RayQuery>& queries,
                       std::uint64_t samples) {
    reference::Options options;
    options.samples = samples;
    options.visible_ground = false;
    const Result<std::vector<reference::Estimate>> truth = reference::trace(params, queries, options);
    const Result<std::vector<models::Answer>> answers = model.answer(queries, false);
    Errors out;
    EXPECT_OK(truth);
    EXPECT_OK(answers);
    if (!truth || !answers) return {{1.0}};
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const reference::Rgb& expected = truth.value()[i].radiance;
      const double largest = std::max({expected[0], expected[1], expected[2]});
      if (largest <= 0.0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        out.all.push_back(std::abs(answers.value()[i].radiance[c] - expected[c]) / largest);
      }
    }
    return out;
  }
};

TEST_F(ScatteringTablesTest, MatchThePathTracer) {
  const Params params;
  Result<models::PrecomputedModel> built = models::PrecomputedModel::create(host(), params);
  ASSERT_OK(built);
  models::PrecomputedModel& model = built.value();
  EXPECT_LE(model.effect().memory().persistent, VkDeviceSize{128} << 20);

  const Errors day = errors(model, params, random_rays(11, 40, 0.0, 90.0), 6000);
  EXPECT_LE(day.mean(), 0.01);
  EXPECT_LE(day.percentile(0.95), 0.03);
  const Errors twilight = errors(model, params, random_rays(12, 30, -6.0, 0.0), 8000);
  EXPECT_LE(twilight.mean(), 0.03);
  const Errors low = errors(model, params, below_sea_level(40), 6000);
  EXPECT_LE(low.mean(), 0.006);
  EXPECT_LE(low.percentile(0.95), 0.02);
  const Errors sky = errors(model, params, skies({70.0, 30.0, 10.0, 3.0, 0.5}), 15000);
  EXPECT_LE(sky.percentile(1.0), 0.0125);
  const Errors late_sky = errors(model, params, skies({-1.0, -3.0}), 25000);
  EXPECT_LE(late_sky.percentile(1.0), 0.03);

  Params integrated = params;
  integrated.scattering.single = SingleScattering::integration;
  ASSERT_OK(model.set_params(integrated));
  ASSERT_TRUE(model.effect().precompute_progress().complete());
  EXPECT_LE(errors(model, params, random_rays(11, 40, 0.0, 90.0), 6000).mean(), 0.007);
}

// Under a low sun in a turbid atmosphere, single scattering grows by a large factor from one altitude of the table to
// the next. The eyes are between two of these altitudes.
TEST_F(ScatteringTablesTest, MatchSingleScatteringBetweenAltitudesInATurbidAtmosphere) {
  Params params;
  params.atmosphere.aerosol_density = 18.94F;  // an optical depth of 0.5
  params.tables.orders = 1;
  Result<models::PrecomputedModel> built = models::PrecomputedModel::create(host(), params);
  ASSERT_OK(built);
  std::vector<RayQuery> queries;
  for (const double altitude_m : {58.0, 130.0, 240.0, 410.0, 645.0, 960.0, 1390.0, 1930.0}) {
    for (const double view_deg : {89.0, 86.0}) {
      for (const double sun_deg : {87.5, 85.5, 81.0}) {
        for (const double azimuth_deg : {5.0, 90.0, 170.0})
          queries.push_back({altitude_m, view_deg * kRadians, sun_deg * kRadians, azimuth_deg * kRadians, false});
      }
    }
  }
  const Result<std::vector<models::Answer>> answers = built.value().answer(queries, false);
  ASSERT_OK(answers);
  const shared::Medium medium = medium_from_params(params);
  Errors errors;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const auto expected = models::single_scattering(medium, models::ray_from_query(queries[i])).radiance;
    const double largest = std::max({expected[0], expected[1], expected[2]});
    for (std::size_t c = 0; c < 3; ++c) {
      errors.all.push_back(std::abs(answers.value()[i].radiance[c] - expected[c]) / largest);
    }
  }
  EXPECT_LE(errors.mean(), 0.01);
  EXPECT_LE(errors.percentile(0.95), 0.03);
}

TEST_F(ScatteringTablesTest, MatchThePathTracerInATurbidAtmosphereNearTheHorizon) {
  Params params;
  params.atmosphere.aerosol_density = 11.36F;  // an optical depth of 0.3
  params.planet.ground_albedo = Vec3(0.4F, 0.2F, 0.05F);
  params.tables.size = {32, 64, 32, 16};
  Result<models::PrecomputedModel> built = models::PrecomputedModel::create(host(), params);
  ASSERT_OK(built);
  std::vector<RayQuery> queries;
  for (const TurbidRay& ray : kTurbidRays) {
    queries.push_back({ray.altitude_m, ray.view_zenith_deg * kRadians, ray.sun_zenith_deg * kRadians,
                       ray.azimuth_deg * kRadians, false});
  }
  const Result<std::vector<models::Answer>> answers = built.value().answer(queries, false);
  ASSERT_OK(answers);
  Errors errors;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const auto& expected = kTurbidRays[i].radiance;
    const double largest = std::max({expected[0], expected[1], expected[2]});
    for (std::size_t c = 0; c < 3; ++c) {
      errors.all.push_back(std::abs(answers.value()[i].radiance[c] - expected[c]) / largest);
    }
  }
  EXPECT_LE(errors.mean(), 0.015);
  EXPECT_LE(errors.percentile(0.95), 0.035);
  EXPECT_LE(errors.percentile(1.0), 0.05);
}

// The axis of the angle between view and sun has few texels. Tables with more of them are the reference here, so that
// neither noise nor the other axes add to the error.
TEST_F(ScatteringTablesTest, FewAnglesBetweenViewAndSunSufficeInATurbidAtmosphere) {
  Params params;
  params.atmosphere.aerosol_density = 18.94F;  // an optical depth of 0.5
  params.tables.size = {16, 64, 48, 61};
  Result<models::PrecomputedModel> many = models::PrecomputedModel::create(host(), params);
  params.tables.size.w = 16;
  Result<models::PrecomputedModel> few = models::PrecomputedModel::create(host(), params);
  ASSERT_OK(many);
  ASSERT_OK(few);
  std::vector<RayQuery> queries;
  for (int i = 0; i < 400; ++i) {
    const double view_deg = 85.0 + 4.5 * (i % 7) / 6.0;
    const double sun_deg = 80.0 + 9.5 * (i % 11) / 10.0;
    queries.push_back({3.0 * i, view_deg * kRadians, sun_deg * kRadians, kPi * ((i * 37) % 400) / 399.0, false});
  }
  const Result<std::vector<models::Answer>> expected = many.value().answer(queries, false);
  const Result<std::vector<models::Answer>> answers = few.value().answer(queries, false);
  ASSERT_OK(expected);
  ASSERT_OK(answers);
  Errors errors;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const auto& truth = expected.value()[i].radiance;
    const double largest = std::max({truth[0], truth[1], truth[2]});
    for (std::size_t c = 0; c < 3; ++c) {
      errors.all.push_back(std::abs(answers.value()[i].radiance[c] - truth[c]) / largest);
    }
  }
  EXPECT_LE(errors.mean(), 0.0015);
  EXPECT_LE(errors.percentile(0.95), 0.005);
  EXPECT_LE(errors.percentile(1.0), 0.02);
}

// Rays from below sea level: downward rays along which the sun sets, and rays of eyes below the lowest altitude of the
// tables. The values are those of the path tracer, with standard errors below 0.5 and 2 % of a ray's largest channel:
//   tyndall probe --model reference --samples 600000 --queries RAYS.csv (the first five rays)
//   tyndall probe --model reference --orders 30 --samples 8000 --queries RAYS.csv
constexpr TurbidRay kSunsetRays[] = {
    {-320.357, 100.4635, 89.818, 45.436, {2.2440e-4, 1.2742e-4, 1.8039e-4}},
    {-64.303, 90.5156, 89.972, 54.37, {8.9056e-4, 5.4281e-4, 7.0584e-4}},
    {-264.05, 92.876, 89.899, 159.213, {4.9420e-4, 3.4851e-4, 5.0628e-4}},
    {-195.914, 92.7233, 89.927, 140.109, {3.5548e-4, 2.5868e-4, 3.9382e-4}},
    {-206.896, 114.3, 89.959, 80.0, {2.1484e-5, 1.8642e-5, 3.8148e-5}},
};
constexpr TurbidRay kDeepRays[] = {
    {-700.0, 70.0, 30.0, 90.0, {0.01148, 0.02243, 0.04691}},
    {-700.0, 88.0, 70.0, 150.0, {0.0343, 0.04592, 0.05027}},
    {-700.0, 120.0, 85.0, 30.0, {0.002138, 0.001195, 7.13e-4}},
    {-1000.0, 70.0, 70.0, 90.0, {0.01049, 0.01894, 0.03574}},
    {-1000.0, 88.0, 30.0, 150.0, {0.02567, 0.03857, 0.05328}},
    {-1000.0, 120.0, 30.0, 30.0, {0.002255, 0.003302, 0.005989}},
    {-2000.0, 70.0, 30.0, 90.0, {0.01637, 0.02724, 0.04936}},
    {-2000.0, 88.0, 70.0, 150.0, {0.0198, 0.02632, 0.03156}},
    {-2000.0, 120.0, 30.0, 30.0, {0.009256, 0.01058, 0.01407}},
};

TEST_F(ScatteringTablesTest, AreRightBelowSeaLevel) {
  Result<models::PrecomputedModel> built = models::PrecomputedModel::create(host(), {});
  ASSERT_OK(built);
  const auto answer = [&](const TurbidRay& ray) {
    const RayQuery query = {ray.altitude_m, ray.view_zenith_deg * kRadians, ray.sun_zenith_deg * kRadians,
                            ray.azimuth_deg * kRadians, false};
    const Result<std::vector<models::Answer>> out = built.value().answer({&query, 1}, false);
    EXPECT_OK(out);
    return out.ok() ? out.value()[0] : models::Answer{};
  };
  const auto error = [&](const TurbidRay& ray) {
    const models::Answer got = answer(ray);
    double worst = 0.0;
    for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(got.radiance[c] - ray.radiance[c]));
    return worst / std::max({ray.radiance[0], ray.radiance[1], ray.radiance[2]});
  };
  for (const TurbidRay& ray : kSunsetRays) EXPECT_LE(error(ray), 0.02) << ray.altitude_m;
  for (const TurbidRay& ray : kDeepRays) {
    // The orders above the first are estimated below -500 m.
    EXPECT_LE(error(ray), ray.altitude_m > -800.0 ? 0.04 : ray.altitude_m > -1500.0 ? 0.08 : 0.2) << ray.altitude_m;
  }
  // Daylight fades out: at -8000 m the path tracer gives 3e-8 to 1e-3 of the sunlight, and at -11 000 m nothing.
  for (const double zenith_deg : {20.0, 88.0, 97.0, 150.0}) {
    double before = 1.0;
    for (const double altitude : {-6000.0, -7000.0, -8000.0, -9000.0, -11000.0}) {
      const models::Answer got = answer({altitude, zenith_deg, 30.0, 90.0, {}});
      for (const double radiance : got.radiance) EXPECT_TRUE(radiance >= 0.0 && radiance < 0.5) << altitude;
      EXPECT_LT(got.radiance[1], before) << zenith_deg << " " << altitude;
      before = got.radiance[1];
    }
    EXPECT_LT(before, 1e-9) << zenith_deg;
  }
}

}  // namespace
}  // namespace tyndall
