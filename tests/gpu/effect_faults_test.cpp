// Every call of the library that can run out of memory does so once, at each of its allocations: the call returns an
// error, nothing has changed, nothing has leaked, and the same call then succeeds.
#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include "effect_frame.hpp"
#include "faults.hpp"

namespace tyndall {
namespace {

using faults::Kind;
constexpr Kind kKinds[] = {Kind::vulkan, Kind::host};

Params small_params() {
  Params params;
  params.tables.size = {8, 16, 16, 4};
  params.tables.orders = 2;
  params.epipolar.slices = 64;
  params.epipolar.samples = 64;
  return params;
}

// Other tables, other buffers and other pipelines.
Params other_params() {
  Params params = small_params();
  params.tables.size = {4, 8, 12, 4};
  params.atmosphere.aerosol_density = 2.0F;
  params.epipolar.slices = 40;
  params.epipolar.refinement_threshold = 0.5F;
  params.shadows.cascade_processing = CascadeProcessing::multi_pass;
  params.scattering.multiple = MultipleScattering::occluded;
  params.scattering.downscale = 2;
  return params;
}

EffectDesc small_desc() {
  EffectDesc desc;
  desc.max_extent = {64, 32};
  desc.output_format = OutputFormat::rgba32f;
  desc.max_shadow_resolution = 64;
  desc.timings = true;
  desc.counters = true;
  return desc;
}

template <typename Handle>
Handle number(std::uintptr_t n) {
  return reinterpret_cast<Handle>(n);
}
const auto kCommands = number<VkCommandBuffer>(7);

FrameInputs fake_frame() {
  static const Cascade cascades[2] = {{{}, 0.0F, 100.0F}, {{}, 100.0F, 1000.0F}};
  FrameInputs inputs;
  inputs.extent = {64, 32};
  inputs.color.view = number<VkImageView>(1000001);
  inputs.depth.view = number<VkImageView>(1000002);
  inputs.shadow_maps.view = number<VkImageView>(1000003);
  inputs.output.view = number<VkImageView>(1000004);
  inputs.shadow_resolution = 64;
  inputs.cascades = cascades;
  inputs.camera.clip_from_view = {{1.0F, 0, 0, 0, 0, -1.0F, 0, 0, 0, 0, 0, -1, 0, 0, 0.1F, 0}};
  return inputs;
}

// What must be the same after a call that was refused.
struct Observed {
  std::size_t frame_commands = 0;
  std::size_t objects = 0;
  MemoryUsage memory;
  Progress progress;
  Params params;
  VkImageView light = VK_NULL_HANDLE;
};

std::size_t commands_of_frame(Effect& effect) {
  faults::forget_commands();
  EXPECT_OK(effect.record(kCommands, fake_frame()));
  return faults::command_hash();
}

Observed observe(Effect& effect) {
  Observed out;
  out.objects = faults::live_objects();
  out.memory = effect.memory();
  out.progress = effect.precompute_progress();
  out.params = effect.params();
  out.light = effect.light_tables().sun_transmittance;
  out.frame_commands = commands_of_frame(effect);
  return out;
}

void expect_same(const Observed& a, const Observed& b, const std::string& where) {
  EXPECT_EQ(a.frame_commands, b.frame_commands) << where;
  EXPECT_EQ(a.objects, b.objects) << where;
  EXPECT_EQ(a.memory.persistent, b.memory.persistent) << where;
  EXPECT_EQ(a.memory.transient, b.memory.transient) << where;
  EXPECT_EQ(a.memory.host, b.memory.host) << where;
  EXPECT_EQ(a.progress.done, b.progress.done) << where;
  EXPECT_EQ(a.progress.total, b.progress.total) << where;
  EXPECT_EQ(affected(a.params, b.params), 0U) << where;
  EXPECT_EQ(a.light, b.light) << where;
}

enum class Built { not_at_all, in_part, completely, others_in_part };  // what tables there are

// An effect of the fake device. Frames have been recorded until nothing waits to be freed.
Effect make(Built built) {
  Result<Effect> made = Effect::create(faults::fake_device(), small_desc(), small_params());
  EXPECT_OK(made);
  Effect effect = std::move(made).value();
  if (built != Built::not_at_all) {
    EXPECT_OK(effect.record_precompute(kCommands, built == Built::in_part ? 5 : UINT32_MAX));
  }
  if (built == Built::others_in_part) {
    EXPECT_OK(effect.set_params(other_params()));
    EXPECT_OK(effect.record_precompute(kCommands, 5));
  }
  for (int frame = 0; frame < 4; ++frame) commands_of_frame(effect);
  return effect;
}

// Refuses `change` at each of its allocations, every time to another effect.
template <typename Change>
void refuse_everywhere(const std::string& name, Built built, const Change& change, long least_vulkan, long least_host) {
  for (const Kind kind : kKinds) {
    long n = 0;
    for (;; ++n) {
      ASSERT_LT(n, 1000) << name;
      const std::string where = name + (kind == Kind::host ? ", operator new " : ", Vulkan call ") + std::to_string(n);
      {
        Effect effect = make(built);
        const Observed before = observe(effect);
        faults::arm(kind, n);
        const Result<void> refused = change(effect);
        const bool failed = faults::disarm();
        ASSERT_EQ(refused.ok(), !failed) << where;
        if (failed) {
          EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory) << where;
          EXPECT_FALSE(refused.error().message.empty()) << where;
          expect_same(before, observe(effect), where);
          ASSERT_OK(change(effect));
        }
        // Whether at once or at the second attempt: what was wanted is there and works.
        const Result<Progress> recorded = effect.record_precompute(kCommands);
        ASSERT_OK(recorded);
        EXPECT_TRUE(recorded.value().complete()) << where;
        for (int frame = 0; frame < 4; ++frame) commands_of_frame(effect);
        EXPECT_EQ(effect.memory().transient, 0U) << where;
        if (!failed) break;
      }
      EXPECT_EQ(faults::live_objects(), 0U) << where;
      EXPECT_EQ(faults::live_pipeline_objects(), 0U) << where;
    }
    // So that nothing passes because nothing was refused.
    EXPECT_GE(n, kind == Kind::vulkan ? least_vulkan : least_host) << name;
  }
}

TEST(EffectFaults, CreationIsRefusedAtEveryAllocation) {
  for (const Kind kind : kKinds) {
    long n = 0;
    for (;; ++n) {
      ASSERT_LT(n, 2000);
      faults::arm(kind, n);
      const Result<Effect> made = Effect::create(faults::fake_device(), small_desc(), small_params());
      const bool failed = faults::disarm();
      ASSERT_EQ(made.ok(), !failed) << n;
      if (!failed) break;
      EXPECT_EQ(made.error().code, ErrorCode::out_of_memory) << n;
      EXPECT_FALSE(made.error().message.empty()) << n;
      EXPECT_EQ(faults::live_objects(), 0U) << n;
      EXPECT_EQ(faults::live_pipeline_objects(), 0U) << n;
    }
    EXPECT_GT(n, kind == Kind::vulkan ? 150 : 40);
  }
  EXPECT_EQ(faults::live_objects(), 0U);
}

TEST(EffectFaults, ParametersAreRefusedAtEveryAllocation) {
  for (const Built built : {Built::not_at_all, Built::in_part, Built::completely}) {
    const std::string name = "set_params, tables built " + std::to_string(static_cast<int>(built));
    refuse_everywhere(
        name, built, [](Effect& effect) { return effect.set_params(other_params()); }, 60, 10);
  }
  // Back to what the finished tables are, from a build that is no longer wanted.
  refuse_everywhere(
      "set_params back", Built::others_in_part, [](Effect& effect) { return effect.set_params(small_params()); }, 10,
      0);
}

TEST(EffectFaults, LimitsAreRefusedAtEveryAllocation) {
  refuse_everywhere(
      "set_limits", Built::completely,
      [](Effect& effect) {
        return effect.set_limits({128, 48}, 6, 300);
      },
      15, 0);
}

// Limits and parameters in one step; what is fixed stays fixed.
TEST(EffectFaults, ParametersAndLimitsAreRefusedAtEveryAllocation) {
  EffectDesc desc = small_desc();
  desc.max_extent = {128, 48};
  desc.shadow_colors = true;
  refuse_everywhere(
      "set_params with limits", Built::completely,
      [&](Effect& effect) { return effect.set_params(other_params(), desc); }, 60, 10);
  Effect effect = make(Built::completely);
  const Observed before = observe(effect);
  const std::function<void(EffectDesc&)> changes[] = {[](EffectDesc& d) { d.views = 2; },
                                                      [](EffectDesc& d) { d.frames_in_flight = 3; },
                                                      [](EffectDesc& d) { d.timings = false; },
                                                      [](EffectDesc& d) { d.counters = false; },
                                                      [](EffectDesc& d) { d.output_format = OutputFormat::rgba16f; },
                                                      [](EffectDesc& d) { d.sky_depth = 1.0F; },
                                                      [](EffectDesc& d) { d.shadow_depth_reversed = true; }};
  for (const auto& change : changes) {
    EffectDesc other = effect.desc();
    change(other);
    EXPECT_FALSE(effect.set_params(other_params(), other).ok());
  }
  expect_same(before, observe(effect), "fixed fields");
}

TEST(EffectFaults, ShadowColorsAreRefusedAtEveryAllocation) {
  refuse_everywhere(
      "set_shadow_colors", Built::completely, [](Effect& effect) { return effect.set_shadow_colors(true); }, 4, 1);
}

TEST(EffectFaults, NoOtherCallThrowsAndRecordingAllocatesNothing) {
  Effect effect = make(Built::in_part);
  const auto survives = [](const char* name, const auto& call) {
    for (long n = 0;; ++n) {
      ASSERT_LT(n, 1000) << name;
      faults::arm(Kind::host, n);
      const bool ok = call();
      if (!faults::disarm()) {
        EXPECT_TRUE(ok) << name;
        return;
      }
    }
  };
  survives("query_memory", [&] { return query_memory(faults::fake_device(), small_desc(), small_params()).ok(); });
  survives("prepare_pipelines", [&] { return effect.prepare_pipelines().ok(); });
  survives("table_key", [&] { return !effect.table_key().empty(); });
  survives("an invalid parameter", [&] {
    Params params;
    params.atmosphere.mie_g = 2.0F;
    return !effect.set_params(params).ok();
  });
  survives("an invalid frame", [&] { return !effect.record(kCommands, {}).ok(); });
  survives("create, out of range", [&] {
    EffectDesc desc;
    desc.frames_in_flight = 0;
    return !Effect::create(faults::fake_device(), desc, {}).ok();
  });
  const auto allocates_nothing = [](const char* name, const auto& call) {
    faults::arm(Kind::host, 0);
    const bool ok = call();
    EXPECT_FALSE(faults::disarm()) << name;
    EXPECT_TRUE(ok) << name;
  };
  const auto buffer = number<VkBuffer>(1000005);
  const FrameInputs inputs = fake_frame();
  allocates_nothing("record", [&] { return effect.record(kCommands, inputs).ok(); });
  allocates_nothing("record_load_tables", [&] { return effect.record_load_tables(kCommands, buffer).ok(); });
  allocates_nothing("record_save_tables", [&] { return effect.record_save_tables(kCommands, buffer).ok(); });
  ASSERT_OK(effect.set_params(other_params()));
  allocates_nothing("record_precompute", [&] { return effect.record_precompute(kCommands).ok(); });
  allocates_nothing("reports", [&] {
    return effect.precompute_progress().complete() && effect.memory().persistent > 0 && !effect.resources().empty() &&
           effect.timings(0).empty() && effect.precompute_timings().size() > 1 && effect.table_bytes() > 0;
  });
}

// Frames without cascades are drawn with the pipelines that set_params() made.
TEST(EffectFaults, RecordingMakesNoPipeline) {
  Effect effect = make(Built::completely);
  FrameInputs inputs = fake_frame();
  inputs.cascades = {};
  const std::size_t before = faults::live_pipeline_objects();
  ASSERT_OK(effect.record(kCommands, inputs));
  EXPECT_EQ(faults::live_pipeline_objects(), before);
}

TEST(EffectFaults, NullCommandBuffersAndMovedFromEffectsAreErrors) {
  Effect effect = make(Built::in_part);
  const auto buffer = number<VkBuffer>(1000005);
  const auto refuses = [&](const Result<void>& outcome) {
    ASSERT_FALSE(outcome.ok());
    EXPECT_EQ(outcome.error().code, ErrorCode::invalid_argument);
    EXPECT_FALSE(outcome.error().message.empty());
  };
  const auto of = [](const Result<Progress>& outcome) {
    return outcome ? Result<void>() : Result<void>(outcome.error());
  };
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
  // It can be used again once another is assigned to it.
  effect = std::move(other);
  EXPECT_OK(effect.record(kCommands, fake_frame()));
}

TEST(EffectFaults, ValuesOutOfRangeAreRefused) {
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

// Limits of a device that some settings exceed.
TEST(EffectFaults, SettingsThatTheDeviceDoesNotAllowAreRefused) {
  struct Case {
    const char* message;  // has this in it
    std::function<void(VkPhysicalDeviceProperties2&)> limit;
    bool for_all;  // whether the small settings do not fit either
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
      {"tables.size", [](P& p) { p.properties.limits.maxImageDimension3D = 32; }, true},
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
    // Nor can it be made too large later.
    commands_of_frame(small.value());  // the first prepares images
    const Observed before = observe(small.value());
    EXPECT_FALSE(small.value().set_limits(large.max_extent, 1, 64).ok());
    expect_same(before, observe(small.value()), c.message);
  }
  // Parameters that a small device does not allow.
  faults::set_properties([](P& p) {
    p.properties.limits.maxStorageBufferRange = 1U << 27;
    p.properties.limits.maxImageDimension3D = 256;
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
  for (const Params& params : {fine, wide}) {
    const Result<void> refused = effect.value().set_params(params);
    EXPECT_FALSE(refused.ok());
    expect_same(before, observe(effect.value()), refused.ok() ? "" : refused.error().message);
  }
  faults::set_properties({});
}

// The same on a device that draws: the picture is, byte for byte, what it was.
class EffectFaultsOnDevice : public GpuTest {
 protected:
  void build(Effect& effect) {
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> built = effect.record_precompute(cmd);
      if (!built) return built.error();
      return {};
    }));
  }
  std::vector<std::byte> draw(Effect& effect, FrameImages& images, const TestFrame& frame) {
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) { return effect.record(cmd, images.inputs(frame)); }));
    Result<std::vector<std::byte>> bytes = images.output_bytes(host());
    EXPECT_OK(bytes);
    return bytes ? std::move(bytes).value() : std::vector<std::byte>();
  }
  // At every fifth call, which comes to every kind of call and nearly every object; the fake device sees the others.
  template <typename Change>
  long refuse_everywhere(Effect& effect, FrameImages& images, const TestFrame& frame, const Change& change) {
    const std::vector<std::byte> before = draw(effect, images, frame);
    const MemoryUsage memory = effect.memory();
    const Progress progress = effect.precompute_progress();
    for (long n = 0; n < 300; n += 5) {
      faults::arm(Kind::vulkan, n);
      const Result<void> refused = change(effect);
      const bool failed = faults::disarm();
      EXPECT_EQ(refused.ok(), !failed) << n;
      if (!failed) return n;
      EXPECT_EQ(draw(effect, images, frame), before) << n;
      EXPECT_EQ(effect.memory().persistent, memory.persistent) << n;
      EXPECT_EQ(effect.precompute_progress().done, progress.done) << n;
      EXPECT_EQ(effect.precompute_progress().total, progress.total) << n;
    }
    return -1;
  }
};

TEST_F(EffectFaultsOnDevice, ThePictureStays) {
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  DeviceInfo device = info();
  device.get_instance_proc_addr = faults::get_instance_proc_addr;
  // With so many slices and no buffer of another resolution, few pipelines are needed: they take most of the time.
  Params params = small_params();
  params.epipolar.slices = 512;
  Params others = other_params();
  others.epipolar.slices = 600;
  others.scattering.downscale = 1;
  others.scattering.multiple = params.scattering.multiple;
  Result<Effect> made = Effect::create(device, desc_for(frame), params);
  ASSERT_OK(made);
  Effect effect = std::move(made).value();
  build(effect);
  // Makes the pipelines, so that the calls below come to every buffer and image. The tables stay: none is built.
  ASSERT_OK(effect.set_params(others));
  ASSERT_OK(effect.set_params(params));
  const std::vector<std::byte> first = draw(effect, images.value(), frame);
  EXPECT_GE(refuse_everywhere(effect, images.value(), frame, [&](Effect& e) { return e.set_params(others); }), 50);
  build(effect);
  const std::vector<std::byte> other = draw(effect, images.value(), frame);
  EXPECT_NE(other, first);
  EXPECT_GE(refuse_everywhere(effect, images.value(), frame,
                              [](Effect& e) {
                                return e.set_limits({200, 100}, 4, 200);
                              }),
            10);
  EXPECT_EQ(draw(effect, images.value(), frame), other);
  EXPECT_GE(refuse_everywhere(effect, images.value(), frame, [](Effect& e) { return e.set_shadow_colors(true); }), 1);
  EXPECT_EQ(draw(effect, images.value(), frame), other);
}

// Of commands that were recorded and have not run, and of those that have.
TEST_F(EffectFaultsOnDevice, DestroyingInFlightIsReported) {
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  std::vector<std::string> said;
  DeviceInfo device = info();
  device.message_user = &said;
  device.message = [](void* user, Severity, std::string_view text) {
    static_cast<std::vector<std::string>*>(user)->emplace_back(text);
  };
  Params params = with_technique(Technique::brute_force);
  params.tables.size = {4, 8, 8, 4};
  EffectDesc desc = desc_for(frame);
  desc.check_inputs = true;
  Result<Effect> made = Effect::create(device, desc, params);
  ASSERT_OK(made);
  std::optional<Effect> effect(std::move(made).value());
  const auto reports = [&] {
    return std::count_if(said.begin(), said.end(),
                         [](const std::string& s) { return s.find("is destroyed") != std::string::npos; });
  };
  draw(*effect, images.value(), frame);
  FrameInputs inputs = images.value().inputs(frame);
  inputs.frame_index = 1;
  Result<void> recorded;
  // The commands are dropped after recording: an error keeps them from being submitted.
  EXPECT_FALSE(host()
                   .run([&](VkCommandBuffer cmd) -> Result<void> {
                     recorded = effect->record(cmd, inputs);
                     return Error{ErrorCode::invalid_argument, "not submitted"};
                   })
                   .ok());
  ASSERT_OK(recorded);
  effect.reset();
  EXPECT_EQ(reports(), 1);
  made = Effect::create(device, desc, params);
  ASSERT_OK(made);
  effect.emplace(std::move(made).value());
  draw(*effect, images.value(), frame);
  effect.reset();
  EXPECT_EQ(reports(), 1);
}

}  // namespace
}  // namespace tyndall
