// The scattering tables are built in slices while frames read the old ones.
#include "table_fixture.hpp"

namespace tyndall {
namespace {

TEST_F(TableBuilderTest, StepsAndRepetitionsGiveTheSameBytes) {
  TableBuilder at_once;
  TableBuilder sliced;
  ASSERT_OK(create(at_once, false, small_tables()));
  ASSERT_OK(create(sliced, true, small_tables()));
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

TEST_F(TableBuilderTest, OldTablesAreUsedUntilNewOnesAreComplete) {
  TableBuilder builder;
  Params params = small_tables();
  ASSERT_OK(create(builder, false, params));
  build(builder, UINT32_MAX);
  const std::uint32_t whole = builder.progress().total;
  const VkImageView high = builder.table(TableId::high_orders).view.get();
  const VkImageView single = builder.table(TableId::single_mie).view.get();
  const std::vector<std::byte> before = bytes(builder, TableId::high_orders);

  // Single scattering does not depend on the ground, so only the higher orders are rebuilt.
  params.planet.ground_albedo = Vec3(0.5F);
  ASSERT_OK(change(builder, params));
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

  // Tables that no frame uses any more are freed.
  for (int frame = 0; frame < 3; ++frame) {
    ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      builder.begin_frame(cmd);
      return {};
    }));
  }
  EXPECT_EQ(builder.transient_bytes(), 0U);

  // A change that is undone before its build is complete does not affect the tables.
  const std::vector<std::byte> now = bytes(builder, TableId::high_orders);
  Params other = params;
  other.atmosphere.aerosol_density = 2.0F;
  ASSERT_OK(change(builder, other));
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) { return builder.record(cmd, 3); }));
  ASSERT_OK(change(builder, params));
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
