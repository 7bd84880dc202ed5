// The sky probe: its irradiance against the table of sky irradiance, and against quadratures of the radiance that
// `probe` returns for single rays; the axes of the caller; amortised updates; misuse.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <vector>

#include "gpu/descriptors.hpp"
#include "gpu/try.hpp"
#include "gpu_test.hpp"
#include "models/precomputed.hpp"
#include "sky_test_shaders.hpp"
#include "tyndall/sky_probe.hpp"

namespace tyndall {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
// The errors that docs/sky_probe.md states for tilted normals, relative to the largest irradiance of any normal.
constexpr double kTruncationMean = 0.03;
constexpr double kTruncationWorst = 0.08;
using Rgb = std::array<double, 3>;
using Coefficients = std::array<std::array<float, 4>, 9>;

// Returns the unit vector with y up, x east and z south.
Vec3 direction(double zenith, double azimuth) {
  return {static_cast<float>(std::sin(zenith) * std::sin(azimuth)), static_cast<float>(std::cos(zenith)),
          static_cast<float>(-std::sin(zenith) * std::cos(azimuth))};
}

// Written without tyndall/sky_probe.glsl: the harmonics of order 2 in closed form, with y, z, x as in the header.
std::array<double, 9> harmonics(const Vec3& d) {
  const double x = d.x, y = d.y, z = d.z;
  const double a = std::sqrt(1.0 / (4.0 * kPi)), b = std::sqrt(3.0 / (4.0 * kPi)), c = std::sqrt(15.0 / (4.0 * kPi));
  return {a,
          b * y,
          b * z,
          b * x,
          c * x * y,
          c * y * z,
          std::sqrt(5.0 / (16.0 * kPi)) * (3.0 * z * z - 1.0),
          c * x * z,
          0.5 * c * (x * x - y * y)};
}

Rgb irradiance(const Coefficients& coefficients, const Vec3& normal) {
  const std::array<double, 9> basis = harmonics(normal);
  Rgb out = {};
  for (std::size_t i = 0; i < 9; ++i) {
    const double cosine = i == 0 ? kPi : i < 4 ? 2.0 * kPi / 3.0 : kPi / 4.0;
    for (std::size_t k = 0; k < 3; ++k) out[k] += cosine * basis[i] * static_cast<double>(coefficients[i][k]);
  }
  return out;
}

// The largest difference of a channel, relative to that channel.
double error_of(const Rgb& found, const Rgb& expected) {
  double out = 0.0;
  for (std::size_t k = 0; k < 3; ++k) out = std::max(out, std::abs(found[k] / expected[k] - 1.0));
  return out;
}

class GpuSkyProbe : public GpuTest {
 protected:
  // All cases share the tables.
  void SetUp() override {
    GpuTest::SetUp();
    if (HasFatalFailure() || model_) return;
    Params params;
    params.scattering.scale = 1.0F;  // as for the rays of the model
    Result<models::PrecomputedModel> made = models::PrecomputedModel::create(host(), params);
    ASSERT_OK(made);
    model_ = std::make_unique<models::PrecomputedModel>(std::move(made).value());
  }
  static void TearDownTestSuite() { model_.reset(); }

  static SkyProbe make(std::uint32_t frames = 2) {
    Result<SkyProbe> probe = SkyProbe::create(model_->effect(), frames);
    EXPECT_OK(probe);
    return std::move(probe).value();
  }
  // Returns inputs with a sun of irradiance 1.
  static SkyProbeInputs inputs(double altitude_m, double sun_zenith, double sun_azimuth = 0.7) {
    SkyProbeInputs out;
    out.altitude_m = static_cast<float>(altitude_m);
    out.sun.direction_to_sun = direction(sun_zenith, sun_azimuth);
    out.sun.irradiance = Vec3(1.0F);
    return out;
  }
  static Coefficients read(const SkyProbe& probe) {
    const SkyCoefficients from = probe.coefficients();
    Coefficients out = {};
    EXPECT_EQ(from.size, sizeof out);
    Result<gpu::Buffer> to = gpu::create_buffer(host().device(), "read", from.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                gpu::MemoryKind::readback);
    EXPECT_OK(to);
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      const VkBufferCopy region = {from.offset, 0, from.size};
      host().device().vk.CmdCopyBuffer(cmd, from.buffer, to.value().buffer.get(), 1, &region);
      gpu::barrier(host().device(), cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                   VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
      return {};
    }));
    std::memcpy(&out, to.value().mapped, sizeof out);
    return out;
  }
  static Result<Progress> record(SkyProbe& probe, const SkyProbeInputs& from, std::uint32_t budget = UINT32_MAX) {
    Progress progress;
    TYNDALL_TRY(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      TYNDALL_ASSIGN(progress, probe.record(cmd, from, budget));
      gpu::barrier(host().device(), cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                   VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
      return {};
    }));
    return progress;
  }
  static Coefficients update(SkyProbe& probe, const SkyProbeInputs& from) {
    const Result<Progress> progress = record(probe, from);
    EXPECT_OK(progress);
    EXPECT_TRUE(progress.value().complete());
    return read(probe);
  }

  static inline std::unique_ptr<models::PrecomputedModel> model_;
};

TEST_F(GpuSkyProbe, SurfacesThatFaceUpwardsHaveTheIrradianceOfTheTable) {
  SkyProbe probe = make();
  double worst = 0.0;
  for (const double altitude : {-300.0, 0.0, 1500.0, 4000.0}) {
    for (const double sun_deg : {0.0, 20.0, 50.0, 70.0, 80.0, 87.0, 90.0, 94.0}) {
      const RayQuery query = {altitude, 0.0, sun_deg * kDegree, 0.0, true};
      const Result<std::vector<models::Answer>> table = model_->answer({&query, 1});
      ASSERT_OK(table);
      const Rgb found = irradiance(update(probe, inputs(altitude, sun_deg * kDegree)), {0.0F, 1.0F, 0.0F});
      const double error = error_of(found, table.value()[0].radiance);
      EXPECT_LT(error, 0.01) << altitude << " m, sun at " << sun_deg << " degrees";
      worst = std::max(worst, error);
    }
  }
  std::printf("upward normals against the table of sky irradiance, up to 4 km: worst %.2f %%\n", 100.0 * worst);
}

// A quadrature over the sphere of the radiance that `probe --model precomputed` returns for single rays.
struct Sphere {
  std::vector<Vec3> directions;
  std::vector<double> weights;
  std::vector<RayQuery> queries;

  Sphere(double altitude, double sun_zenith, double sun_azimuth) {
    constexpr int kZeniths = 180, kAzimuths = 180;
    for (int i = 0; i < kZeniths; ++i) {
      for (int j = 0; j < kAzimuths; ++j) {
        const double zenith = (i + 0.5) * kPi / kZeniths;
        const double azimuth = (j + 0.5) * 2.0 * kPi / kAzimuths;
        directions.push_back(direction(zenith, azimuth + sun_azimuth));
        weights.push_back(std::sin(zenith) * (kPi / kZeniths) * (2.0 * kPi / kAzimuths));
        queries.push_back({altitude, zenith, sun_zenith, azimuth, false});
      }
    }
  }
  [[nodiscard]] Rgb irradiance(const std::vector<models::Answer>& radiance, const Vec3& n) const {
    Rgb out = {};
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const Vec3& d = directions[i];
      const double cosine = static_cast<double>(d.x * n.x + d.y * n.y + d.z * n.z);
      for (std::size_t k = 0; k < 3; ++k) out[k] += weights[i] * std::max(cosine, 0.0) * radiance[i].radiance[k];
    }
    return out;
  }
};

// The table of sky irradiance has few altitudes, between which it is off by up to 2 % at high altitudes. The probe
// agrees with the radiance.
TEST_F(GpuSkyProbe, SurfacesThatFaceUpOrDownAgreeWithTheRadianceAtAnyAltitude) {
  SkyProbe probe = make();
  double worst = 0.0;
  for (const double altitude : {200.0, 12000.0, 60000.0}) {
    const Sphere sphere(altitude, 60.0 * kDegree, 0.7);
    const Result<std::vector<models::Answer>> radiance = model_->answer(sphere.queries);
    ASSERT_OK(radiance);
    const Coefficients found = update(probe, inputs(altitude, 60.0 * kDegree));
    for (const float y : {1.0F, -1.0F}) {
      const Vec3 normal = {0.0F, y, 0.0F};
      const double error = error_of(irradiance(found, normal), sphere.irradiance(radiance.value(), normal));
      EXPECT_LT(error, 0.005) << altitude << " m, " << y;
      worst = std::max(worst, error);
    }
  }
  std::printf("normals up and down against a quadrature of the radiance, up to 60 km: worst %.2f %%\n", 100.0 * worst);
}

// For normals that are not vertical, the only error is the missing part of higher harmonics.
TEST_F(GpuSkyProbe, TiltedSurfacesHaveTheErrorOfTheTruncationOnly) {
  SkyProbe probe = make();
  constexpr double kAzimuth = 0.7;
  std::printf("normals tilted by 15 to 165 degrees, difference relative to the largest irradiance of a normal\n");
  std::printf("sun zenith        mean r, g, b         worst r, g, b\n");
  for (const double sun_deg : {10.0, 45.0, 70.0, 85.0, 92.0}) {
    const Sphere sphere(200.0, sun_deg * kDegree, kAzimuth);
    const Result<std::vector<models::Answer>> radiance = model_->answer(sphere.queries);
    ASSERT_OK(radiance);
    const Coefficients coefficients = update(probe, inputs(200.0, sun_deg * kDegree, kAzimuth));
    Rgb mean = {}, worst = {}, largest = {};
    double count = 0.0;
    for (int tilt = 15; tilt <= 165; tilt += 15) {
      for (int azimuth = 0; azimuth < 360; azimuth += 45) {
        const Vec3 normal = direction(tilt * kDegree, azimuth * kDegree + kAzimuth);
        const Rgb found = irradiance(coefficients, normal), exact = sphere.irradiance(radiance.value(), normal);
        count += 1.0;
        for (std::size_t k = 0; k < 3; ++k) {
          mean[k] += std::abs(found[k] - exact[k]);
          worst[k] = std::max(worst[k], std::abs(found[k] - exact[k]));
          largest[k] = std::max(largest[k], exact[k]);
        }
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      mean[k] /= count * largest[k];
      worst[k] /= largest[k];
      EXPECT_LT(mean[k], kTruncationMean) << sun_deg;
      EXPECT_LT(worst[k], kTruncationWorst) << sun_deg;
    }
    std::printf("%10.0f   %5.1f %5.1f %5.1f %%   %5.1f %5.1f %5.1f %%\n", sun_deg, 100.0 * mean[0], 100.0 * mean[1],
                100.0 * mean[2], 100.0 * worst[0], 100.0 * worst[1], 100.0 * worst[2]);
  }
}

// The functions for shaders of engines.
TEST_F(GpuSkyProbe, ShadersGetTheIrradianceOfTheCoefficients) {
  SkyProbe probe = make();
  const Coefficients coefficients = update(probe, inputs(100.0, 1.3));
  std::vector<std::array<float, 4>> normals;
  for (int i = 0; i < 40; ++i) {
    const Vec3 n = direction(0.08 * i, 1.7 * i);
    normals.push_back({n.x, n.y, n.z, 0.0F});
  }
  const gpu::Device& device = host().device();
  const VkDeviceSize size = normals.size() * sizeof normals[0];
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  Result<gpu::Buffer> from = gpu::create_buffer(device, "normals", size, kUsage, gpu::MemoryKind::upload);
  Result<gpu::Buffer> to = gpu::create_buffer(device, "results", size, kUsage, gpu::MemoryKind::readback);
  Result<gpu::Pipeline> pipeline = gpu::create_compute_pipeline(device, shaders::sky_normals_comp);
  ASSERT_OK(from);
  ASSERT_OK(to);
  ASSERT_OK(pipeline);
  std::memcpy(from.value().mapped, normals.data(), size);
  const gpu::NamedResource resources[] = {gpu::named_buffer("sky_block", probe.coefficients().buffer),
                                          gpu::named_buffer("normal_block", from.value().buffer.get()),
                                          gpu::named_buffer("result_block", to.value().buffer.get())};
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    TYNDALL_TRY(gpu::bind(host().sets(), cmd, pipeline.value(), resources));
    gpu::dispatch(device, cmd, pipeline.value(), static_cast<std::uint32_t>(normals.size()));
    gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                 VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    return {};
  }));
  const auto* results = static_cast<const float*>(to.value().mapped);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Rgb expected = irradiance(coefficients, {normals[i][0], normals[i][1], normals[i][2]});
    // Truncated harmonics are slightly negative for some normals near the nadir.
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(static_cast<double>(results[4 * i + k]), std::max(expected[k], 0.0), 1e-6) << i;
    }
  }
}

// An engine with z up, in which x is north, passes its own axes and gets its own coefficients.
TEST_F(GpuSkyProbe, CoefficientsAreInTheAxesOfTheCaller) {
  SkyProbe probe = make();
  const Coefficients y_up = update(probe, inputs(500.0, 1.1));
  const auto turned = [](const Vec3& d) { return Vec3(-d.z, -d.x, d.y); };  // x north, y west, z up
  SkyProbeInputs other = inputs(500.0, 1.1);
  other.up = turned(other.up);
  other.sun.direction_to_sun = turned(other.sun.direction_to_sun);
  const Coefficients z_up = update(probe, other);
  for (const double zenith : {0.0, 0.8, 1.9, 3.0}) {
    for (const double azimuth : {0.0, 1.0, 4.0}) {
      const Vec3 normal = direction(zenith, azimuth);
      EXPECT_LT(error_of(irradiance(z_up, turned(normal)), irradiance(y_up, normal)), 1e-4) << zenith << " " << azimuth;
    }
  }
}

TEST_F(GpuSkyProbe, UpdatesInSlicesGiveTheSameBytesAndChangeThemWithTheLastOne) {
  SkyProbe probe = make();
  ASSERT_OK(record(probe, inputs(0.0, 0.4), 1));
  EXPECT_EQ(read(probe), Coefficients()) << "zero until the first update is complete";
  ASSERT_OK(record(probe, inputs(0.0, 0.4)));
  const SkyProbeInputs noon = inputs(0.0, 0.4);
  const SkyProbeInputs evening = inputs(0.0, 1.5);
  const Coefficients first = update(probe, noon);
  SkyProbe once = make();
  const Coefficients expected = update(once, evening);
  Progress progress = {0, 1};
  for (std::uint32_t slices = 0; slices < 100 && !progress.complete();) {
    // Inputs count in the first slice of an update only.
    const Result<Progress> recorded = record(probe, slices == 0 ? evening : noon, 2);
    ASSERT_OK(recorded);
    progress = recorded.value();
    slices = progress.done;
    if (!progress.complete()) {
      EXPECT_EQ(read(probe), first) << progress.done;
    }
  }
  EXPECT_GT(progress.total, 4U);
  EXPECT_EQ(read(probe), expected);
  // Irradiance scales the light. A budget of 0 records nothing, and does not begin an update.
  SkyProbeInputs brighter = evening;
  brighter.sun.irradiance = {2.0F, 0.0F, 8.0F};
  const Coefficients scaled = update(probe, brighter);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(scaled[i][0], 2.0F * expected[i][0]);
    EXPECT_EQ(scaled[i][1], 0.0F);
    EXPECT_EQ(scaled[i][2], 8.0F * expected[i][2]);
    EXPECT_EQ(scaled[i][3], 0.0F);
  }
  const Result<Progress> nothing = record(probe, noon, 0);
  ASSERT_OK(nothing);
  EXPECT_TRUE(nothing.value().complete());
}

// Suns at the zenith and at the nadir have no azimuth, and points at the limits of the altitude see no horizon below or
// nothing above.
TEST_F(GpuSkyProbe, ExtremesAreFinite) {
  SkyProbe probe = make();
  for (const double altitude : {-10000.0, 0.0, static_cast<double>(Params().atmosphere.height_m)}) {
    for (const double sun : {0.0, 1e-5, 0.5 * kPi, kPi}) {
      for (const auto& coefficient : update(probe, inputs(altitude, sun))) {
        for (const float value : coefficient) EXPECT_TRUE(std::isfinite(value)) << altitude << " m, " << sun;
      }
    }
  }
}

TEST_F(GpuSkyProbe, MemoryIsWhatTheQuerySays) {
  const SkyProbe probe = make(3);
  const Result<MemoryUsage> query = SkyProbe::query_memory(info(), 3);
  ASSERT_OK(query);
  EXPECT_EQ(query.value().persistent, probe.memory().persistent);
  EXPECT_EQ(query.value().host, probe.memory().host);
  EXPECT_GT(query.value().persistent, 48U * 11U * 16U);
  EXPECT_FALSE(SkyProbe::query_memory(info(), 0).ok());
  EXPECT_FALSE(SkyProbe::query_memory({}, 2).ok());
}

TEST_F(GpuSkyProbe, MisuseIsAnError) {
  const auto expect_error = [](const Result<Progress>& result, const char* text) {
    ASSERT_FALSE(result.ok());
    EXPECT_NE(result.error().message.find(text), std::string::npos) << result.error().message;
  };
  SkyProbe probe = make(1);
  const SkyProbeInputs good = inputs(0.0, 1.0);
  EXPECT_FALSE(probe.record(VK_NULL_HANDLE, good).ok());
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    SkyProbeInputs wrong = good;
    wrong.up = {0.0F, 2.0F, 0.0F};
    expect_error(probe.record(cmd, wrong), "SkyProbeInputs::up is not a unit vector");
    wrong = good;
    wrong.sun.direction_to_sun = {};
    expect_error(probe.record(cmd, wrong), "Sun::direction_to_sun is not a unit vector");
    wrong = good;
    wrong.sun.irradiance.y = -1.0F;
    expect_error(probe.record(cmd, wrong), "Sun::irradiance is negative");
    wrong = good;
    wrong.altitude_m = 1.0e6F;
    expect_error(probe.record(cmd, wrong), "SkyProbeInputs::altitude_m is 1000000");
    wrong.altitude_m = std::nanf("");
    expect_error(probe.record(cmd, wrong), "SkyProbeInputs::altitude_m");
    TYNDALL_ASSIGN(const Progress done, probe.record(cmd, good));
    EXPECT_TRUE(done.complete());
    expect_error(probe.record(cmd, good), "have not completed");
    return {};
  }));
  EXPECT_FALSE(SkyProbe::create(model_->effect(), 9).ok());
  // Tables that were never built, and a medium without a sky.
  EffectDesc desc;
  desc.max_extent = {16, 16};
  Params params;
  params.tables.size = {4, 8, 8, 4};
  params.scattering.medium = MediumKind::homogeneous;
  Result<Effect> effect = Effect::create(info(), desc, params);
  ASSERT_OK(effect);
  Result<SkyProbe> other = SkyProbe::create(effect.value());
  ASSERT_OK(other);
  expect_error(record(other.value(), good), "scattering.medium is homogeneous");
  params.scattering.medium = MediumKind::atmosphere;
  ASSERT_OK(effect.value().set_params(params));
  expect_error(record(other.value(), good), "the tables were never built");
  const SkyProbe moved = std::move(other).value();
  EXPECT_FALSE(record(other.value(), good).ok());  // NOLINT(bugprone-use-after-move)
  EXPECT_NE(moved.coefficients().buffer, VK_NULL_HANDLE);
}

}  // namespace
}  // namespace tyndall
