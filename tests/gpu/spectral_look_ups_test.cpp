// Compares the look-ups of engines with scattering.color = spectral with `probe`: tyndall/atmosphere.glsl with the
// macro TYNDALL_SPECTRAL, the light look-up tables and the sky probe. Tests a phase function that has a formula, and
// one that shaders read from rows. All of them read the same small tables.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>

#include "atmosphere_points.hpp"
#include "effect/spectral_medium.hpp"
#include "effect_frame.hpp"
#include "models/precomputed.hpp"
#include "models/spectral.hpp"
#include "tyndall/atmosphere.hpp"
#include "tyndall/sky_probe.hpp"

namespace tyndall {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadius_m = 6360000.0;
constexpr double kAltitude_m = 300.0;

glm::dvec3 color(const FourChannels& light) {
  const std::array<double, 3> out = color_of_light(light);
  return {out[0], out[1], out[2]};
}

// Returns the unit vector with z up and the azimuth from x.
glm::dvec3 direction(double zenith, double azimuth) {
  return {std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)};
}

Vec3 single(const glm::dvec3& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

class SpectralLookUps : public GpuTest, public testing::WithParamInterface<MiePhase> {
 protected:
  static Params params() {
    Params out;
    out.scattering.color = ColorMode::spectral;
    out.scattering.scale = 1.0F;
    out.atmosphere.mie_phase = GetParam();
    out.atmosphere.droplet_diameter_um = 3.0F;
    out.planet.ground_albedo = Vec3(0.3F, 0.2F, 0.1F);
    out.tables.size = {8, 32, 16, 8};
    out.tables.orders = 2;
    return out;
  }
  void SetUp() override {
    GpuTest::SetUp();
    if (model_ && made_for_ == GetParam()) return;
    model_.reset();
    made_for_ = GetParam();
    Result<models::PrecomputedModel> made = models::PrecomputedModel::create(host(), params());
    ASSERT_OK(made);
    model_.emplace(std::move(made).value());
  }
  static void TearDownTestSuite() { model_.reset(); }

  static std::vector<models::Answer> probe(const std::vector<RayQuery>& queries, bool visible_ground) {
    Result<std::vector<models::Answer>> answers = model_->answer(queries, visible_ground);
    EXPECT_OK(answers);
    return answers.ok() ? std::move(answers).value() : std::vector<models::Answer>(queries.size());
  }

  // Evaluates the functions of tyndall/atmosphere.glsl at a point above the ground, with z up.
  static std::vector<Answer> evaluate(const glm::dvec3& to_sun, const std::vector<Query>& queries) {
    AtmosphereInputs inputs;
    inputs.origin_from_centre_m = {0.0, 0.0, kRadius_m + kAltitude_m};
    inputs.sun.irradiance = Vec3(1.0F);
    inputs.sun.direction_to_sun = single(to_sun);
    return evaluate_points(host(), model_->effect(), table_params(model_->effect()), inputs, queries);
  }

  static inline std::optional<models::PrecomputedModel> model_;
  static inline MiePhase made_for_ = {};
};

TEST_P(SpectralLookUps, AtmosphereGlslAgreesWithProbe) {
  for (const double sun_deg : {30.0, 82.0, 93.0}) {
    const double sun_zenith = sun_deg * kPi / 180.0;
    std::vector<Query> queries;
    std::vector<RayQuery> rays, skies;
    for (const double view_deg : {5.0, 40.0, 75.0, 88.0, 95.0, 150.0}) {
      for (const double azimuth : {0.1, 1.0, 2.0, 3.0}) {
        const double zenith = view_deg * kPi / 180.0;
        const glm::dvec3 ahead = direction(zenith, azimuth);
        queries.push_back(query(sun_irradiance, {}, ahead));
        queries.push_back(query(sky_irradiance, {}, {0.0, 0.0, 1.0}));
        queries.push_back(query(sky_radiance, {}, ahead));
        queries.push_back(query(to_sky, {}, ahead));
        rays.push_back({kAltitude_m, zenith, sun_zenith, azimuth, false});
        skies.push_back({kAltitude_m, zenith, sun_zenith, azimuth, true});
      }
    }
    const std::vector<Answer> found = evaluate(direction(sun_zenith, 0.0), queries);
    const std::vector<models::Answer> sky = probe(skies, true), seen = probe(rays, true), path = probe(rays, false);
    const auto expect_near = [&](const char* what, const glm::dvec3& value, const FourChannels& light) {
      const glm::dvec3 truth = color(light);
      EXPECT_LE(glm::length(value - truth), 0.003 * std::max({truth.x, truth.y, truth.z}) + 1e-9)
          << what << ", sun at " << sun_deg << ": " << value.x << ' ' << value.y << ' ' << value.z << ", expected "
          << truth.x << ' ' << truth.y << ' ' << truth.z;
    };
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Answer* a = &found[4 * i];
      if (sun_deg < 90.0) expect_near("sun", a[0].light, models::transmittance_of(sky[i]));
      expect_near("sky irradiance", a[1].light, models::radiance_of(sky[i]));
      expect_near("sky radiance", a[2].light, models::radiance_of(seen[i]));
      expect_near("in-scattering", a[3].light, models::radiance_of(path[i]));
    }
  }
}

// The irradiance of surfaces that face up, from the coefficients, against a quadrature of single rays.
TEST_P(SpectralLookUps, TheSkyProbeAgreesWithTheRadianceOfProbe) {
  Result<SkyProbe> made = SkyProbe::create(model_->effect());
  ASSERT_OK(made);
  SkyProbe sky = std::move(made).value();
  const double sun_zenith = 70.0 * kPi / 180.0;
  std::vector<RayQuery> rays;
  std::vector<double> weights;
  constexpr int kZeniths = 90, kAzimuths = 60;
  for (int i = 0; i < kZeniths; ++i) {
    for (int j = 0; j < kAzimuths; ++j) {
      const double zenith = (i + 0.5) * kPi / 2.0 / kZeniths;
      rays.push_back({kAltitude_m, zenith, sun_zenith, (j + 0.5) * kPi / kAzimuths, false});
      weights.push_back(std::cos(zenith) * std::sin(zenith) * (kPi / 2.0 / kZeniths) * (2.0 * kPi / kAzimuths));
    }
  }
  const std::vector<models::Answer> radiance = probe(rays, true);
  glm::dvec3 expected = {};
  for (std::size_t i = 0; i < rays.size(); ++i) expected += weights[i] * color(models::radiance_of(radiance[i]));

  SkyProbeInputs inputs;
  inputs.up = {0.0F, 0.0F, 1.0F};
  inputs.altitude_m = static_cast<float>(kAltitude_m);
  inputs.sun.direction_to_sun = single(direction(sun_zenith, 0.4));
  inputs.sun.irradiance = Vec3(1.0F);
  const SkyCoefficients from = sky.coefficients();
  Result<gpu::Buffer> to = gpu::create_buffer(host().device(), "read", from.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                              gpu::MemoryKind::readback);
  ASSERT_OK(to);
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    const Result<Progress> recorded = sky.record(cmd, inputs);
    if (!recorded.ok()) return recorded.error();
    gpu::barrier(host().device(), cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                 VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    const VkBufferCopy region = {from.offset, 0, from.size};
    host().device().vk.CmdCopyBuffer(cmd, from.buffer, to.value().buffer.get(), 1, &region);
    gpu::barrier(host().device(), cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                 VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    return {};
  }));
  std::array<std::array<float, 4>, 9> coefficients = {};
  std::memcpy(&coefficients, to.value().mapped, sizeof coefficients);
  // The functions of docs/sky_probe.md that are not 0 for the normal (0, 0, 1).
  constexpr double kFactors[9] = {
      0.282095 * kPi, 0.0, 0.488603 * 2.0 * kPi / 3.0, 0.0, 0.0, 0.0, 0.630783 * kPi / 4.0, 0.0, 0.0};
  for (std::size_t c = 0; c < 3; ++c) {
    double found = 0.0;
    for (std::size_t i = 0; i < 9; ++i) found += kFactors[i] * static_cast<double>(coefficients[i][c]);
    EXPECT_NEAR(found / expected[static_cast<int>(c)], 1.0, 0.005) << c;
  }
}

INSTANTIATE_TEST_SUITE_P(Phase, SpectralLookUps, testing::Values(MiePhase::cornette_shanks, MiePhase::draine));

}  // namespace
}  // namespace tyndall
