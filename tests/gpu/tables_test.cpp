// The scattering tables: how far what the renderer reads from them is from the path tracer, and how they are
// built. The floors are those of docs/tables.md, with room for the noise of the few paths traced here.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "effect/tables.hpp"
#include "gpu_test.hpp"
#include "models/precomputed.hpp"
#include "reference/path_tracer.hpp"

namespace tyndall {
namespace {

constexpr double kPi = 3.14159265358979;
constexpr double kRadians = kPi / 180.0;

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

std::vector<reference::Query> random_rays(std::uint32_t seed, int count, double lowest_sun, double highest_sun) {
  std::mt19937 engine(seed);
  const auto uniform = [&] { return static_cast<double>(engine()) / 4294967296.0; };
  std::vector<reference::Query> out;
  for (int i = 0; i < count; ++i) {
    reference::Query query;
    const double u = uniform();
    query.altitude_m = 70000.0 * (i % 2 == 0 ? u : u * u * u);
    query.view_zenith_rad = std::acos(1.0 - 2.0 * uniform());
    query.sun_zenith_rad = (90.0 - lowest_sun - (highest_sun - lowest_sun) * uniform()) * kRadians;
    query.azimuth_rad = kPi * uniform();
    out.push_back(query);
  }
  return out;
}

std::vector<reference::Query> skies(std::initializer_list<double> elevations_deg) {
  std::vector<reference::Query> out;
  for (const double elevation : elevations_deg) {
    for (const double altitude : {0.0, 1500.0}) {
      reference::Query query;
      query.altitude_m = altitude;
      query.sun_zenith_rad = (90.0 - elevation) * kRadians;
      query.sky_irradiance = true;
      out.push_back(query);
    }
  }
  return out;
}

class ScatteringTablesTest : public GpuTest {
 protected:
  // How the model answers queries, against `samples` paths of eight orders each.
  static Errors errors(models::PrecomputedModel& model, const Params& params,
                       const std::vector<reference::Query>& queries, std::uint64_t samples) {
    reference::Options options;
    options.samples = samples;
    options.visible_ground = false;
    const Result<std::vector<reference::Estimate>> truth = reference::trace(params, queries, options);
    std::vector<models::PrecomputedQuery> asked;
    for (const reference::Query& q : queries) {
      asked.push_back({models::ray_from_angles(q.altitude_m, q.view_zenith_rad, q.sun_zenith_rad, q.azimuth_rad),
                       q.sky_irradiance});
    }
    const Result<std::vector<models::Answer>> answers = model.answer(asked, false);
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

TEST_F(ScatteringTablesTest, AreAsRightAsThePathTracer) {
  const Params params;
  Result<models::PrecomputedModel> built = models::PrecomputedModel::create(host(), params, {}, 1000);
  ASSERT_OK(built);
  models::PrecomputedModel& model = built.value();
  EXPECT_LE(model.effect().memory().persistent, VkDeviceSize{128} << 20);

  const Errors day = errors(model, params, random_rays(11, 40, 0.0, 90.0), 6000);
  EXPECT_LE(day.mean(), 0.01);
  EXPECT_LE(day.percentile(0.95), 0.03);
  const Errors twilight = errors(model, params, random_rays(12, 30, -6.0, 0.0), 8000);
  EXPECT_LE(twilight.mean(), 0.03);
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

// Small and quick; what is tested with it does not depend on the size.
Params small_tables() {
  Params params;
  params.tables.size = {6, 16, 12, 4};
  params.tables.orders = 2;
  return params;
}

class TableBuilderTest : public GpuTest {
 protected:
  void build(TableBuilder& builder, std::uint32_t budget) {
    while (!builder.progress().complete()) {
      ASSERT_OK(host().run([&](VkCommandBuffer cmd) { return builder.record(cmd, budget); }));
    }
  }
  std::vector<std::byte> bytes(const TableBuilder& builder, TableId id) {
    Result<std::vector<std::byte>> out = gpu::download(host(), builder.table(id), VK_IMAGE_LAYOUT_GENERAL, 0, 8);
    EXPECT_OK(out);
    return out ? std::move(out).value() : std::vector<std::byte>();
  }
};

TEST_F(TableBuilderTest, SlicesAndRepetitionsGiveTheSameBytes) {
  TableBuilder at_once;
  TableBuilder sliced;
  ASSERT_OK(at_once.create(host().device(), 1, false, small_tables()));
  ASSERT_OK(sliced.create(host().device(), 1, true, small_tables()));
  build(at_once, UINT32_MAX);
  build(sliced, 1);
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    const auto id = static_cast<TableId>(i);
    EXPECT_EQ(bytes(at_once, id), bytes(sliced, id)) << i;
  }
  double total_ms = 0.0;
  for (const PassTiming& time : sliced.stage_times()) total_ms += time.gpu_ms;
  EXPECT_GT(total_ms, 0.0);
}

TEST_F(TableBuilderTest, OldTablesServeUntilTheNewOnesAreWhole) {
  TableBuilder builder;
  Params params = small_tables();
  ASSERT_OK(builder.create(host().device(), 1, false, params));
  build(builder, UINT32_MAX);
  const std::uint32_t whole = builder.progress().total;
  const VkImageView high = builder.table(TableId::high_orders).view.get();
  const VkImageView single = builder.table(TableId::single_mie).view.get();
  const std::vector<std::byte> before = bytes(builder, TableId::high_orders);

  // The ground has no part in light scattered once: only the higher orders are built again.
  params.planet.ground_albedo = 0.5F;
  ASSERT_OK(builder.set_params(params));
  EXPECT_LT(builder.progress().total, whole);
  EXPECT_GT(builder.transient_bytes(), 0U);
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) { return builder.record(cmd, builder.progress().total - 1); }));
  EXPECT_FALSE(builder.progress().complete());
  EXPECT_EQ(builder.table(TableId::high_orders).view.get(), high);
  EXPECT_EQ(bytes(builder, TableId::high_orders), before);
  build(builder, 1);
  EXPECT_NE(builder.table(TableId::high_orders).view.get(), high);
  EXPECT_NE(bytes(builder, TableId::high_orders), before);
  EXPECT_EQ(builder.table(TableId::single_mie).view.get(), single);

  // What no frame uses any more is freed.
  for (int frame = 0; frame < 3; ++frame) {
    ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      builder.begin_frame(cmd);
      return {};
    }));
  }
  EXPECT_EQ(builder.transient_bytes(), 0U);

  // A change that is taken back before it is complete leaves the tables as they are.
  const std::vector<std::byte> now = bytes(builder, TableId::high_orders);
  Params other = params;
  other.atmosphere.aerosol_density = 2.0F;
  ASSERT_OK(builder.set_params(other));
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) { return builder.record(cmd, 3); }));
  ASSERT_OK(builder.set_params(params));
  EXPECT_TRUE(builder.progress().complete());
  EXPECT_EQ(bytes(builder, TableId::high_orders), now);
}

TEST_F(TableBuilderTest, SizesThatNoDeviceHoldsAreRefused) {
  Params params = small_tables();
  params.tables.size = {4096, 4096, 4096, 4096};
  EXPECT_FALSE(Effect::create(info(), {}, params).ok());
  params.tables.size = {8, 15, 8, 8};
  EXPECT_FALSE(Effect::create(info(), {}, params).ok());
  params.tables.size = {4, 4, 4096, 1024};
  EXPECT_FALSE(Effect::create(info(), {}, params).ok());
  EXPECT_FALSE(query_memory(info(), {}, params).ok());
}

}  // namespace
}  // namespace tyndall
