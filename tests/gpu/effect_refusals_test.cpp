// The effect refuses null handles, effects that were moved from, values out of range, and settings that exceed the
// limits of the device. Refusals change nothing.
#include <cstring>
#include <functional>
#include <string>

#include "small_effect.hpp"

namespace tyndall {
namespace {

TEST(EffectRefusals, NullCommandBuffersAndMovedFromEffectsAreErrors) {
  Effect effect = make(Built::in_part);
  const auto buffer = number<VkBuffer>(1000005);
  const auto refuses = [&](const Result<void>& result) {
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
    EXPECT_FALSE(result.error().message.empty());
  };
  const auto of = [](const Result<Progress>& result) { return result ? Result<void>() : Result<void>(result.error()); };
  const auto all_recording = [&](VkCommandBuffer cmd) {
    refuses(effect.record(cmd, fake_frame()));
    refuses(of(effect.record_precompute(cmd)));
    refuses(of(effect.record_precompute(cmd, 0)));
    refuses(effect.record_load_tables(cmd, buffer));
    refuses(effect.record_save_tables(cmd, buffer));
  };
  faults::forget_commands();
  all_recording(VK_NULL_HANDLE);
  EXPECT_EQ(faults::command_hash(), 0U);
  EXPECT_EQ(effect.precompute_progress().done, 5U);

  // NOLINTBEGIN(bugprone-use-after-move): an effect that was moved from refuses every call.
  Effect other = std::move(effect);
  all_recording(kCommands);
  refuses(effect.set_params({}));
  refuses(effect.set_limits({64, 64}, 1, 64));
  refuses(effect.set_shadow_colors(true));
  refuses(of(effect.prepare_pipelines()));
  EXPECT_EQ(affected(effect.params(), Params{}), 0U);
  EXPECT_EQ(effect.precompute_progress().total, 0U);
  EXPECT_EQ(effect.memory().persistent, 0U);
  EXPECT_EQ(effect.light_tables().sky_irradiance, VkImageView{VK_NULL_HANDLE});
  EXPECT_EQ(effect.scattering_tables().high_orders.image, VkImage{VK_NULL_HANDLE});
  EXPECT_EQ(effect.counters(0).samples_marched, 0U);
  EXPECT_EQ(effect.table_key(), "");
  EXPECT_EQ(effect.table_bytes(), 0U);
  EXPECT_TRUE(effect.resources().empty());
  EXPECT_TRUE(effect.timings(0).empty());
  EXPECT_TRUE(effect.precompute_timings().empty());
  // NOLINTEND(bugprone-use-after-move)
  // It can be used again after another effect has been assigned to it.
  effect = std::move(other);
  EXPECT_OK(effect.record(kCommands, fake_frame()));
}

TEST(EffectRefusals, ValuesOutOfRangeAreRefused) {
  EffectDesc desc = small_desc();
  desc.output_format = static_cast<OutputFormat>(2);
  EXPECT_FALSE(Effect::create(faults::fake_device(), desc, small_params()).ok());
  EXPECT_FALSE(query_memory(faults::fake_device(), desc, small_params()).ok());
  for (const ParamInfo& row : param_table()) {
    if (row.type != ParamType::flag && row.type != ParamType::enumeration) continue;
    Params params = small_params();
    const std::uint32_t bad = row.type == ParamType::flag ? 2 : 1000;
    std::memcpy(reinterpret_cast<char*>(&params) + row.offset, &bad, sizeof bad);
    const Result<Effect> made = Effect::create(faults::fake_device(), small_desc(), params);
    ASSERT_FALSE(made.ok()) << row.group << "." << row.name;
    EXPECT_NE(made.error().message.find(row.name), std::string::npos) << made.error().message;
  }
}

// Devices over another interface, such as MoltenVK, are refused if they lack a feature of Vulkan that the effect needs.
TEST(EffectRefusals, DevicesWithTooSmallASubsetOfVulkanAreRefused) {
  for (const bool comparison_samplers : {false, true}) {
    for (const bool events : {false, true}) {
      faults::set_portability(faults::PortabilitySubset{comparison_samplers, events});
      const Result<Effect> made = Effect::create(faults::fake_device(), small_desc(), small_params());
      EXPECT_EQ(made.ok(), comparison_samplers && events);
      if (made.ok()) continue;
      EXPECT_EQ(made.error().code, ErrorCode::unsupported_device);
      const char* feature = comparison_samplers ? "without events" : "without mutableComparisonSamplers";
      EXPECT_NE(made.error().message.find(feature), std::string::npos) << made.error().message;
    }
  }
  faults::set_portability({});
}

// Settings that exceed a limit of the device are refused with a message that names them.
TEST(EffectRefusals, SettingsThatTheDeviceDoesNotAllowAreRefused) {
  struct Case {
    const char* message;  // contained in the error message
    std::function<void(VkPhysicalDeviceProperties2&)> limit;
    bool for_all;  // small settings exceed the limit, too
  };
  const auto buffers = [](VkPhysicalDeviceProperties2& p, VkDeviceSize bytes) {
    for (auto* next = static_cast<VkBaseOutStructure*>(p.pNext); next != nullptr; next = next->pNext) {
      if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES) {
        reinterpret_cast<VkPhysicalDeviceMaintenance4Properties*>(next)->maxBufferSize = bytes;
      }
    }
  };
  const auto allocations = [](VkPhysicalDeviceProperties2& p, VkDeviceSize bytes) {
    for (auto* next = static_cast<VkBaseOutStructure*>(p.pNext); next != nullptr; next = next->pNext) {
      if (next->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES) {
        reinterpret_cast<VkPhysicalDeviceMaintenance3Properties*>(next)->maxMemoryAllocationSize = bytes;
      }
    }
  };
  using P = VkPhysicalDeviceProperties2;
  const Case cases[] = {
      {"EffectDesc::max_extent", [](P& p) { p.properties.limits.maxStorageBufferRange = 1U << 27; }, false},
      {"EffectDesc::max_extent", [&](P& p) { buffers(p, 1U << 27); }, false},
      {"EffectDesc::max_extent", [&](P& p) { allocations(p, 1U << 27); }, false},
      {"storage buffers", [](P& p) { p.properties.limits.maxPerStageDescriptorStorageBuffers = 4; }, true},
      {"groups", [](P& p) { p.properties.limits.maxComputeWorkGroupCount[0] = 1024; }, true},
      {"invocations", [](P& p) { p.properties.limits.maxComputeWorkGroupInvocations = 16; }, true},
      {"3D images", [](P& p) { p.properties.limits.maxImageDimension3D = 256; }, true},
  };
  EffectDesc large = small_desc();
  large.max_extent = {16384, 16384};
  for (const Case& c : cases) {
    faults::set_properties(c.limit);
    const Result<Effect> refused = Effect::create(faults::fake_device(), large, small_params());
    ASSERT_FALSE(refused.ok()) << c.message;
    EXPECT_NE(refused.error().message.find(c.message), std::string::npos) << refused.error().message;
    EXPECT_FALSE(query_memory(faults::fake_device(), large, small_params()).ok()) << c.message;
    EXPECT_EQ(faults::live_objects(), 0U);
    Result<Effect> small = Effect::create(faults::fake_device(), small_desc(), small_params());
    EXPECT_EQ(small.ok(), !c.for_all) << c.message;
    if (!small.ok()) continue;
    // Later changes to such settings are refused, too.
    commands_of_frame(small.value());  // the first frame also prepares images
    const Observed before = observe(small.value());
    EXPECT_FALSE(small.value().set_limits(large.max_extent, 1, 64).ok());
    expect_same(before, observe(small.value()), c.message);
  }
  // Parameters that exceed a limit of the device are refused, too.
  faults::set_properties([](P& p) {
    p.properties.limits.maxStorageBufferRange = 1U << 27;
    p.properties.limits.maxImageDimension3D = 1024;
  });
  Result<Effect> effect = Effect::create(faults::fake_device(), small_desc(), small_params());
  ASSERT_OK(effect);
  commands_of_frame(effect.value());
  const Observed before = observe(effect.value());
  Params fine = small_params();
  fine.epipolar.slices = 2048;
  fine.epipolar.samples = 2048;
  fine.shadows.cascade_processing = CascadeProcessing::multi_pass;
  Params wide = small_params();
  wide.epipolar.slices = 32;
  wide.tables.size = {4, 4, 4096, 16};
  for (const Params* const chosen : {&fine, &wide}) {
    const Params& params = *chosen;
    const Result<void> refused = effect.value().set_params(params);
    ASSERT_FALSE(refused.ok());
    const bool of_tables = refused.error().message.find("tables.size") != std::string::npos;
    EXPECT_EQ(of_tables, &params == &wide) << refused.error().message;
    expect_same(before, observe(effect.value()), refused.error().message);
  }
  faults::set_properties({});
}

}  // namespace
}  // namespace tyndall
