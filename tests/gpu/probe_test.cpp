// Compares shaders/probe/single.comp on the device with the CPU model in double precision, and with a quadrature that
// shares no code with shaders/lib. The documented errors of `single` are 0.2 % on average and at most 1 % of the
// brightest channel of the ray.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "../unit/physics_quadrature.hpp"
#include "effect/medium.hpp"
#include "gpu_test.hpp"
#include "models/gpu_probe.hpp"

namespace tyndall {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMeanError = 0.002;
constexpr double kWorstError = 0.01;

struct Query {
  models::Ray ray;
  double azimuth = 0.0;
};

// Returns random queries: altitudes of 0 to 79 km (a third of them below 3 km, where most of the atmosphere is),
// uniform view directions, and suns up to 100 degrees from the zenith.
std::vector<Query> random_queries(int count) {
  std::mt19937 engine(20240607);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Query> out;
  for (int i = 0; i < count; ++i) {
    const double altitude = (i % 3 == 0 ? 3000.0 : 79000.0) * uniform(engine);
    const double view = std::acos(1.0 - 2.0 * uniform(engine));
    const double sun = 100.0 / 180.0 * kPi * uniform(engine);
    const double azimuth = 2.0 * kPi * uniform(engine);
    out.push_back({models::ray_from_angles(altitude, view, sun, azimuth), azimuth});
  }
  return out;
}

struct Errors {
  double mean = 0.0, worst = 0.0;
  int count = 0;

  void add(double error) {
    ++count;
    mean += (error - mean) / count;
    worst = std::max(worst, error);
  }
};

double error_of(const std::array<double, 3>& value, const std::array<double, 3>& truth) {
  const double brightest = std::max({truth[0], truth[1], truth[2]});
  double difference = 0.0;
  for (std::size_t c = 0; c < 3; ++c) difference = std::max(difference, std::abs(value[c] - truth[c]));
  // Without light, any radiance is an error.
  return brightest > 0.0 ? difference / brightest : (difference > 0.0 ? 1.0 : 0.0);
}

class GpuProbe : public GpuTest {
 protected:
  std::vector<models::Answer> probe(const shared::Medium& medium, const std::vector<Query>& queries) {
    std::vector<models::Ray> rays;
    for (const Query& q : queries) rays.push_back(q.ray);
    Result<std::vector<models::Answer>> answers = models::single_scattering_on_gpu(host(), medium, rays);
    EXPECT_OK(answers);
    return answers.ok() ? std::move(answers).value() : std::vector<models::Answer>(rays.size());
  }
};

TEST_F(GpuProbe, AgreesWithDoublePrecision) {
  const shared::Medium medium = medium_from_params({});
  const std::vector<Query> queries = random_queries(1000);
  const std::vector<models::Answer> answers = probe(medium, queries);
  ASSERT_EQ(answers.size(), queries.size());
  Errors radiance;
  Errors transmittance;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const models::Answer truth = models::single_scattering(medium, queries[i].ray);
    radiance.add(error_of(answers[i].radiance, truth.radiance));
    transmittance.add(error_of(answers[i].transmittance, truth.transmittance));
  }
  RecordProperty("mean_percent", std::to_string(100.0 * radiance.mean));
  RecordProperty("worst_percent", std::to_string(100.0 * radiance.worst));
  EXPECT_LE(radiance.mean, kMeanError);
  EXPECT_LE(radiance.worst, kWorstError);
  EXPECT_LE(transmittance.mean, kMeanError);
  EXPECT_LE(transmittance.worst, kWorstError);
}

TEST_F(GpuProbe, AgreesWithQuadrature) {
  const shared::Medium medium = medium_from_params({});
  const std::vector<Query> queries = random_queries(1000);
  const std::vector<models::Answer> answers = probe(medium, queries);
  ASSERT_EQ(answers.size(), queries.size());
  Errors errors;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const models::Ray& ray = queries[i].ray;
    // The error of the quadrature itself is far below the tolerance.
    const brute::Three truth = brute::single_scattering(medium, ray.altitude_m, ray.cos_view_zenith, ray.cos_sun_zenith,
                                                        queries[i].azimuth, 1e-4);
    errors.add(error_of(answers[i].radiance, truth));
  }
  RecordProperty("mean_percent", std::to_string(100.0 * errors.mean));
  RecordProperty("worst_percent", std::to_string(100.0 * errors.worst));
  EXPECT_LE(errors.mean, kMeanError);
  EXPECT_LE(errors.worst, kWorstError);
}

TEST_F(GpuProbe, ResultsAreInOrderAcrossBatches) {
  const shared::Medium medium = medium_from_params({});
  std::vector<models::Ray> rays;
  for (int i = 0; i < 40000; ++i) rays.push_back(models::ray_from_angles(200.0 * (i % 390), 0.1, 0.5, 0.0));
  std::size_t reported = 0;
  const Result<std::vector<models::Answer>> answers =
      models::single_scattering_on_gpu(host(), medium, rays, [&](std::size_t done) {
        EXPECT_GT(done, reported);
        reported = done;
      });
  ASSERT_OK(answers);
  EXPECT_EQ(reported, rays.size());
  ASSERT_EQ(answers.value().size(), rays.size());
  for (std::size_t i = 390; i < rays.size(); ++i) {
    ASSERT_EQ(answers.value()[i].radiance, answers.value()[i - 390].radiance) << i;
  }
  EXPECT_LT(answers.value()[389].radiance[1], answers.value()[0].radiance[1]);
  const Result<std::vector<models::Answer>> none = models::single_scattering_on_gpu(host(), medium, {});
  ASSERT_OK(none);
  EXPECT_TRUE(none.value().empty());
}

}  // namespace
}  // namespace tyndall
