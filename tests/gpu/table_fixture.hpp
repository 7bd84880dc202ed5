// Small tables on a device: builds them, and saves and loads them in the same way as an engine.
#pragma once

#include <cstring>
#include <utility>
#include <vector>

#include "effect/tables.hpp"
#include "gpu/try.hpp"
#include "gpu_test.hpp"

namespace tyndall {

// Returns parameters with small tables, for tests that do not depend on their size.
inline Params small_tables() {
  Params params;
  params.tables.size = {6, 16, 12, 4};
  params.tables.orders = 2;
  params.scattering.enabled = false;  // no frames are drawn: creating their pipelines would take most of the time
  return params;
}

class TableBuilderTest : public GpuTest {
 protected:
  void TearDown() override {
    pipelines_ = {};
    GpuTest::TearDown();
  }
  static Result<void> change(TableBuilder& builder, const Params& params) {
    TYNDALL_ASSIGN(TableBuilder::Pending pending, builder.plan(params));
    builder.commit(std::move(pending));
    return {};
  }
  Result<void> create(TableBuilder& builder, bool timings, const Params& params) {
    pipelines_.create(host().device(), 1);
    TYNDALL_TRY(builder.create(host().device(), pipelines_, {1, timings, false}));
    return change(builder, params);
  }
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

 private:
  PipelineCache pipelines_;
};

// Saves and loads tables through the public interface, as an engine does.
class SavedTablesTest : public TableBuilderTest {
 protected:
  Effect make(const Params& params, bool built) {
    EffectDesc desc;
    desc.max_extent = {16, 16};
    Result<Effect> effect = Effect::create(info(), desc, params);
    EXPECT_OK(effect);
    if (built) build(effect.value());
    return std::move(effect).value();
  }
  void build(Effect& effect, std::uint32_t budget = UINT32_MAX) {
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> recorded = effect.record_precompute(cmd, budget);
      if (!recorded.ok()) return recorded.error();
      return {};
    }));
  }
  gpu::Buffer buffer(VkDeviceSize size) {
    Result<gpu::Buffer> out = gpu::create_buffer(host().device(), "saved", size,
                                                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                 gpu::MemoryKind::readback);
    EXPECT_OK(out);
    return std::move(out).value();
  }
  std::vector<std::byte> save(Effect& effect, VkDeviceSize offset = 0) {
    const VkDeviceSize size = offset + effect.table_bytes();
    const gpu::Buffer to = buffer(size);
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      if (Result<void> r = effect.record_save_tables(cmd, to.buffer.get(), offset); !r.ok()) return r;
      gpu::barrier(host().device(), cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                   VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
      return {};
    }));
    const auto* bytes = static_cast<const std::byte*>(to.mapped);
    return {bytes + offset, bytes + size};
  }
  Result<void> load(Effect& effect, const std::vector<std::byte>& bytes, VkDeviceSize offset = 0) {
    const gpu::Buffer from = buffer(offset + bytes.size());
    std::memcpy(static_cast<std::byte*>(from.mapped) + offset, bytes.data(), bytes.size());
    return host().run([&](VkCommandBuffer cmd) { return effect.record_load_tables(cmd, from.buffer.get(), offset); });
  }
};

}  // namespace tyndall
