// The scattering tables: how far what the renderer reads from them is from the path tracer. The floors are those of
// docs/tables.md, with room for the noise of the few paths traced here.
#include <algorithm>
#include <cmath>

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

// From the shore of the Dead Sea and a little higher.
std::vector<RayQuery> below_sea_level(int count) {
  std::vector<RayQuery> out = random_rays(13, count, 5.0, 90.0);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i].altitude_m = i % 2 == 0 ? -400.0 : -430.0 * out[i].azimuth_rad / kPi;
  return out;
}

// Turbid air near the horizon under a low sun: light scattered many times, of which the last orders are estimated.
// Path tracer's values (standard errors of 0.1 to 0.5 % of a ray's largest channel) of
//   tyndall probe --model reference --orders 24 --samples 150000 --seed 3 --queries RAYS.csv
//     --set atmosphere.aerosol_density=11.36 --set planet.ground_albedo=0.2
struct TurbidRay {
  double altitude_m, view_zenith_deg, sun_zenith_deg, azimuth_deg;
  double radiance[3];  // over the sun's irradiance [1/sr]
};
constexpr TurbidRay kTurbidRays[] = {
    {303.0, 85.6, 81.6, 11.0, {0.47728, 0.2906, 0.13358}},
    {200.0, 89.1, 83.6, 3.0, {0.28346, 0.15158, 0.0577}},
    {337.0, 86.8, 86.2, 22.0, {0.078457, 0.036901, 0.0154}},
    {615.0, 88.8, 80.5, 144.0, {0.017407, 0.019248, 0.022576}},
    {121.0, 86.9, 82.7, 150.0, {0.012215, 0.013042, 0.015042}},
    {427.0, 86.6, 83.8, 66.0, {0.023853, 0.018538, 0.016081}},
    {953.0, 86.5, 88.4, 133.0, {0.0066659, 0.0054182, 0.0054768}},
    {20.0, 89.3, 85.3, 172.0, {0.0061999, 0.0063432, 0.0076686}},
    {668.0, 87.3, 86.5, 72.0, {0.012551, 0.0093448, 0.0086873}},
    {461.0, 88.3, 84.8, 165.0, {0.010159, 0.010274, 0.011476}},
    {704.0, 86.2, 89.2, 104.0, {0.0039826, 0.003234, 0.0037137}},
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
  ASSERT_OK(model.effect().set_params(integrated));
  ASSERT_TRUE(model.effect().precompute_progress().complete());
  EXPECT_LE(errors(model, params, random_rays(11, 40, 0.0, 90.0), 6000).mean(), 0.007);
}

TEST_F(ScatteringTablesTest, MatchThePathTracerInATurbidAtmosphereNearTheHorizon) {
  Params params;
  params.atmosphere.aerosol_density = 11.36F;  // an optical depth of 0.3
  params.planet.ground_albedo = 0.2F;
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

}  // namespace
}  // namespace tyndall
