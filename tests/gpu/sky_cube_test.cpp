// The cube map of a sky probe: the texels of level 0 against `probe`, the other levels against sums over level 0 and
// quadratures of the radiance of `probe`; amortised updates; misuse. With three channels, and with spectral and a phase
// function that shaders read from rows. Small tables, which all sides read.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <numbers>
#include <optional>

#include "effect/spectral_medium.hpp"
#include "models/precomputed.hpp"
#include "models/spectral.hpp"
#include "sky_cube_look_ups.hpp"

namespace tyndall {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr double kIrradiance = 1000.0;  // of the sun, so that half floats resolve the light of twilight
constexpr std::uint32_t kSize = 32;
constexpr std::uint32_t kLevels = 6;

using Level = std::vector<glm::dvec3>;  // six faces
using Cube = std::vector<Level>;

// Returns the direction of a texel, by the table "Cube Map Face Selection" of the Vulkan specification.
glm::dvec3 direction_of(std::size_t index, std::size_t width) {
  const std::size_t face = index / (width * width), y = index / width % width, x = index % width;
  const double s = (static_cast<double>(x) + 0.5) / static_cast<double>(width) * 2.0 - 1.0;
  const double t = (static_cast<double>(y) + 0.5) / static_cast<double>(width) * 2.0 - 1.0;
  switch (face) {
    case 0: return glm::normalize(glm::dvec3(1.0, -t, -s));
    case 1: return glm::normalize(glm::dvec3(-1.0, -t, s));
    case 2: return glm::normalize(glm::dvec3(s, 1.0, t));
    case 3: return glm::normalize(glm::dvec3(s, -1.0, -t));
    case 4: return glm::normalize(glm::dvec3(s, -t, 1.0));
    default: return glm::normalize(glm::dvec3(-s, -t, -1.0));
  }
}

// Returns the solid angle of a texel, by the density at its centre.
double solid_angle(std::size_t index, std::size_t width) {
  const glm::dvec3 d = direction_of(index, width);
  const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  return 4.0 / static_cast<double>(width * width) * largest * largest * largest;
}

struct Place {
  glm::dvec3 up, to_sun;
  double altitude_m;

  Place(double altitude, double sun_zenith, const glm::dvec3& axis = {0.2, 0.9, -0.3}) : altitude_m(altitude) {
    up = glm::normalize(axis);
    const glm::dvec3 ahead = glm::normalize(glm::cross(up, glm::dvec3(0.3, 0.1, 0.8)));
    to_sun = std::cos(sun_zenith) * up + std::sin(sun_zenith) * ahead;
  }
  [[nodiscard]] SkyProbeInputs inputs() const {
    const auto single = [](const glm::dvec3& v) { return Vec3(glm::vec3(v).x, glm::vec3(v).y, glm::vec3(v).z); };
    SkyProbeInputs out;
    out.up = single(up);
    out.altitude_m = static_cast<float>(altitude_m);
    out.sun.direction_to_sun = single(to_sun);
    out.sun.irradiance = Vec3(static_cast<float>(kIrradiance));
    return out;
  }
  [[nodiscard]] RayQuery query(const glm::dvec3& d) const {
    const auto angle = [](double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); };
    const glm::dvec3 view = d - up * glm::dot(up, d), sun = to_sun - up * glm::dot(up, to_sun);
    const double azimuth = angle(glm::dot(view, sun) / std::max(glm::length(view) * glm::length(sun), 1e-12));
    return {altitude_m, angle(glm::dot(up, d)), angle(glm::dot(up, to_sun)), azimuth, false};
  }
};

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }
double difference(const glm::dvec3& a, const glm::dvec3& b) { return largest(glm::abs(a - b)); }

class SkyCubeMap : public GpuTest, public testing::WithParamInterface<ColorMode> {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (HasFatalFailure() || models_[index()]) return;
    Params params;
    params.scattering.scale = 1.0F;
    params.scattering.color = GetParam();
    params.scattering.single = SingleScattering::table;  // as the probe
    params.planet.ground_albedo = Vec3(0.3F, 0.2F, 0.1F);
    if (GetParam() == ColorMode::spectral) params.atmosphere.mie_phase = MiePhase::draine;
    params.atmosphere.droplet_diameter_um = 3.0F;
    params.tables.size = {16, 64, 32, 16};
    params.tables.orders = 3;
    Result<models::PrecomputedModel> made = models::PrecomputedModel::create(host(), params);
    ASSERT_OK(made);
    models_[index()].emplace(std::move(made).value());
  }
  static void TearDownTestSuite() { models_ = {}; }
  static std::size_t index() { return GetParam() == ColorMode::spectral ? 1 : 0; }
  static models::PrecomputedModel& model() { return *models_[index()]; }

  static SkyProbe make(std::uint32_t size = kSize) {
    Result<SkyProbe> probe = SkyProbe::create(model().effect(), SkyProbeDesc{2, size});
    EXPECT_OK(probe);
    return std::move(probe).value();
  }
  static Progress record(SkyProbe& probe, const Place& place, std::uint32_t budget = UINT32_MAX) {
    Progress progress;
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      TYNDALL_ASSIGN(progress, probe.record(cmd, place.inputs(), budget));
      gpu::compute_barrier(host().device(), cmd);
      return {};
    }));
    return progress;
  }
  // Returns the texels of all levels, over kIrradiance.
  static Cube read(const SkyProbe& probe) {
    const SkyCube cube = probe.cube();
    const VkDeviceSize bytes = (VkDeviceSize{8} * cube.size * cube.size - 2) * 8;
    Result<gpu::Buffer> to =
        gpu::create_buffer(host().device(), "read", bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::readback);
    EXPECT_OK(to);
    std::vector<VkBufferImageCopy> regions(cube.levels);
    VkDeviceSize offset = 0;
    for (std::uint32_t level = 0; level < cube.levels; ++level) {
      const std::uint32_t width = cube.size >> level;
      regions[level].bufferOffset = offset;
      regions[level].imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 6};
      regions[level].imageExtent = {width, width, 1};
      offset += VkDeviceSize{48} * width * width;
    }
    EXPECT_EQ(offset, bytes);
    const gpu::Device& device = host().device();
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                   VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
      device.vk.CmdCopyImageToBuffer(cmd, cube.image, VK_IMAGE_LAYOUT_GENERAL, to.value().buffer.get(), cube.levels,
                                     regions.data());
      gpu::barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                   VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
      return {};
    }));
    Cube out(cube.levels);
    const auto* texel = static_cast<const glm::u16vec4*>(to.value().mapped);
    for (std::uint32_t level = 0; level < cube.levels; ++level) {
      const std::size_t width = cube.size >> level;
      for (std::size_t i = 0; i < 6 * width * width; ++i, ++texel) {
        const glm::dvec4 value(glm::unpackHalf(*texel));
        EXPECT_TRUE(std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z));
        out[level].push_back(glm::dvec3(value) / kIrradiance);
      }
    }
    return out;
  }
  static Cube update(SkyProbe& probe, const Place& place) {
    EXPECT_TRUE(record(probe, place).complete());
    return read(probe);
  }
  // Returns the radiance that `probe --model precomputed` returns.
  static std::vector<glm::dvec3> radiance(const std::vector<RayQuery>& queries) {
    Result<std::vector<models::Answer>> answers = model().answer(queries, true);
    EXPECT_OK(answers);
    std::vector<glm::dvec3> out;
    for (const models::Answer& a : answers.value()) {
      const std::array<double, 3> c =
          GetParam() == ColorMode::spectral ? color_of_light(models::radiance_of(a)) : a.radiance;
      out.emplace_back(c[0], c[1], c[2]);
    }
    return out;
  }

  static inline std::array<std::optional<models::PrecomputedModel>, 2> models_;
};

TEST_P(SkyCubeMap, Level0HasTheRadianceOfProbe) {
  SkyProbe probe = make();
  double worst = 0.0;
  for (const double altitude : {-300.0, 200.0, 12000.0}) {
    for (const double sun_deg : {0.0, 35.0, 80.0, 90.0, 94.0}) {
      const Place place(altitude, sun_deg * kDegree);
      const Level found = update(probe, place)[0];
      std::vector<RayQuery> queries;
      for (std::size_t i = 0; i < found.size(); ++i) queries.push_back(place.query(direction_of(i, kSize)));
      const std::vector<glm::dvec3> expected = radiance(queries);
      for (std::size_t i = 0; i < found.size(); ++i) {
        const double error = difference(found[i], expected[i]) / largest(expected[i]);
        worst = std::max(worst, error);
        ASSERT_LE(error, 0.003) << altitude << " m, sun at " << sun_deg << " degrees, texel " << i << ", zenith angle "
                                << queries[i].view_zenith_rad / kDegree;
      }
    }
  }
  std::printf("level 0 against probe: worst %.3f %%\n", 100.0 * worst);
}

// Each level is the mean of level 0 under the lobe of its roughness, here in double precision and at full resolution.
TEST_P(SkyCubeMap, OtherLevelsAreMeansUnderTheLobe) {
  SkyProbe probe = make(64);
  const Cube cube = update(probe, Place(200.0, 75.0 * kDegree));
  ASSERT_EQ(cube.size(), 7U);
  const Level& all = cube[0];
  std::vector<glm::dvec3> directions;
  std::vector<double> weights;
  for (std::size_t i = 0; i < all.size(); ++i) {
    directions.push_back(direction_of(i, 64));
    weights.push_back(solid_angle(i, 64));
  }
  for (std::size_t level = 1; level < cube.size(); ++level) {
    const double roughness = std::min(static_cast<double>(level) / 3.0, 1.0);
    const double alpha = roughness * roughness;
    const std::size_t width = std::size_t{64} >> level;
    double worst = 0.0;
    for (std::size_t i = 0; i < 6 * width * width; i += 1 + cube[level].size() / 200) {
      const glm::dvec3 normal = direction_of(i, width);
      glm::dvec3 sum = {};
      double total = 0.0;
      for (std::size_t k = 0; k < all.size(); ++k) {
        const double cosine = glm::dot(normal, directions[k]);
        if (cosine <= 0.0) continue;
        const double half = glm::dot(normal, glm::normalize(normal + directions[k]));
        const double base = half * half * (alpha * alpha - 1.0) + 1.0;
        const double weight = alpha * alpha / (base * base) * cosine * weights[k];
        sum += weight * all[k];
        total += weight;
      }
      worst = std::max(worst, difference(cube[level][i], sum / total) / largest(sum / total));
    }
    std::printf("level %zu against sums over level 0: worst %.3f %%\n", level, 100.0 * worst);
    EXPECT_LE(worst, 0.005) << level;
  }
}

// Compares reflections of roughness 1 in any direction with a quadrature of the radiance that `probe` returns. The
// remaining error is that of linear interpolation between the 8 x 8 texels of a face.
TEST_P(SkyCubeMap, ReflectionsOfRoughnessOneAreTheMeanUnderTheCosine) {
  SkyProbe probe = make(64);
  for (const double sun_deg : {10.0, 70.0, 92.0}) {
    const Place place(200.0, sun_deg * kDegree);
    record(probe, place);
    std::vector<glm::dvec3> directions;
    std::vector<double> weights;
    std::vector<RayQuery> queries;
    const glm::dvec3 east = glm::normalize(glm::cross(place.up, glm::dvec3(1.0, 0.0, 0.0)));
    const glm::dvec3 north = glm::cross(east, place.up);
    const auto direction = [&](double zenith, double azimuth) {
      return std::cos(zenith) * place.up + std::sin(zenith) * (std::cos(azimuth) * east + std::sin(azimuth) * north);
    };
    constexpr int kZeniths = 180, kAzimuths = 120;
    for (int i = 0; i < kZeniths; ++i) {
      for (int j = 0; j < kAzimuths; ++j) {
        const double zenith = (i + 0.5) * kPi / kZeniths;
        directions.push_back(direction(zenith, (j + 0.5) * 2.0 * kPi / kAzimuths));
        weights.push_back(std::sin(zenith) * (kPi / kZeniths) * (2.0 * kPi / kAzimuths));
        queries.push_back(place.query(directions.back()));
      }
    }
    const std::vector<glm::dvec3> light = radiance(queries);
    std::vector<glm::vec4> normals;
    for (int tilt = 0; tilt <= 180; tilt += 15) {
      for (int azimuth = 0; azimuth < 360; azimuth += 40) {
        normals.emplace_back(glm::vec3(direction(tilt * kDegree, azimuth * kDegree)), 1.0F);
      }
    }
    const std::vector<glm::dvec3> found = look_up(host(), probe.cube(), normals);
    double worst = 0.0, brightest = 0.0;
    for (std::size_t n = 0; n < normals.size(); ++n) {
      glm::dvec3 expected = {};
      for (std::size_t i = 0; i < light.size(); ++i) {
        expected += std::max(glm::dot(glm::dvec3(normals[n]), directions[i]), 0.0) * weights[i] * light[i];
      }
      worst = std::max(worst, difference(kPi * found[n] / kIrradiance, expected));
      brightest = std::max(brightest, largest(expected));
    }
    std::printf("sun at %.0f degrees, roughness 1: worst %.2f %% of the brightest direction\n", sun_deg,
                100.0 * worst / brightest);
    EXPECT_LE(worst, 0.02 * brightest) << sun_deg;
  }
}

TEST_P(SkyCubeMap, UpdatesInSlicesGiveTheSameTexelsAndChangeThemWithTheLastOne) {
  SkyProbe probe = make();
  const Place noon(0.0, 0.4), evening(0.0, 1.5);
  record(probe, noon, 1);
  EXPECT_EQ(read(probe)[0], Level(6 * kSize * kSize, glm::dvec3(0.0))) << "black until the first update is complete";
  record(probe, noon);
  const Cube first = update(probe, noon);
  SkyProbe once = make();
  const Cube expected = update(once, evening);
  Progress progress = {0, 1};
  for (int calls = 0; calls < 100 && !progress.complete(); ++calls) {
    progress = record(probe, calls == 0 ? evening : noon, 3);
    if (!progress.complete()) {
      EXPECT_EQ(read(probe), first) << progress.done;
    }
  }
  EXPECT_TRUE(progress.complete());
  EXPECT_EQ(read(probe), expected);
}

// Shaders find reflections where they are, and blend between levels.
TEST_P(SkyCubeMap, ShadersLookUpReflections) {
  SkyProbe probe = make();
  const Cube cube = update(probe, Place(200.0, 1.0));
  std::vector<glm::vec4> queries;
  std::vector<glm::dvec3> expected;
  for (std::size_t level = 0; level <= 2; ++level) {
    for (std::size_t i = 5; i < cube[level].size(); i += 37) {
      queries.emplace_back(glm::vec3(direction_of(i, kSize >> level)), 0.5F * static_cast<float>(level));
      expected.push_back(cube[level][i] * kIrradiance);
    }
  }
  const std::vector<glm::dvec3> found = look_up(host(), probe.cube(), queries);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LE(difference(found[i], expected[i]), 0.02 * largest(expected[i])) << i;
  }
}

TEST_P(SkyCubeMap, ExtremesAreFinite) {
  SkyProbe probe = make();
  for (const double altitude : {-10000.0, 0.0, static_cast<double>(Params().atmosphere.height_m)}) {
    for (const double sun : {0.0, 1e-5, 0.5 * kPi, kPi}) update(probe, Place(altitude, sun, {0.0, 1.0, 0.0}));
  }
}

TEST_P(SkyCubeMap, MemoryAndMisuse) {
  const SkyProbe probe = make(64), none = make(0);
  const Result<MemoryUsage> query = SkyProbe::query_memory(info(), SkyProbeDesc{2, 64});
  ASSERT_OK(query);
  EXPECT_EQ(query.value().persistent, probe.memory().persistent);
  EXPECT_EQ(query.value().host, probe.memory().host);
  EXPECT_GE(probe.memory().persistent - none.memory().persistent, 2U * 262'128U + 516'096U);
  EXPECT_EQ(none.cube().view, VK_NULL_HANDLE);
  EXPECT_EQ(none.cube().levels, 0U);
  EXPECT_EQ(probe.cube().size, 64U);
  EXPECT_EQ(make().cube().levels, kLevels);
  for (const std::uint32_t size : {1U, 16U, 48U, 256U}) {
    const Result<SkyProbe> made = SkyProbe::create(model().effect(), SkyProbeDesc{2, size});
    ASSERT_FALSE(made.ok());
    EXPECT_NE(made.error().message.find("cube_size " + std::to_string(size) + "; expected 0, 32, 64 or 128"),
              std::string::npos)
        << made.error().message;
    EXPECT_FALSE(SkyProbe::query_memory(info(), SkyProbeDesc{2, size}).ok());
  }
}

INSTANTIATE_TEST_SUITE_P(Color, SkyCubeMap, testing::Values(ColorMode::rgb, ColorMode::spectral));

}  // namespace
}  // namespace tyndall
