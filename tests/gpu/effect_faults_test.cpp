// Each function of the library that allocates memory is called once for each of its allocations, which then fails. It
// must return an error, change nothing and leak nothing, and the same call must succeed afterwards.
#include <functional>
#include <iostream>
#include <string>

#include "small_effect.hpp"
#include "tyndall/sky_probe.hpp"

namespace tyndall {
namespace {

using faults::Kind;
constexpr Kind kKinds[] = {Kind::vulkan, Kind::host};

void print_count(const std::string& name, Kind kind, long faults) {
  std::cout << faults << (kind == Kind::host ? " failing allocations of the host" : " failing calls of Vulkan") << ": "
            << name << "\n";
}

// Lets each allocation of `change` fail once, each time with a new effect.
template <typename Change>
void refuse_everywhere(const std::string& name, Built built, const Change& change, long min_vulkan, long min_host) {
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
        // After the first or the second attempt, the change is complete and works.
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
    // Verify that allocations have failed.
    EXPECT_GE(n, kind == Kind::vulkan ? min_vulkan : min_host) << name;
    print_count(name, kind, n);
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
    print_count("Effect::create", kind, n);
  }
  EXPECT_EQ(faults::live_objects(), 0U);
}

// A refused probe leaves the effect as it was.
TEST(EffectFaults, SkyProbesAreRefusedAtEveryAllocation) {
  Effect effect = make(Built::completely);
  const std::size_t objects = faults::live_objects(), pipelines = faults::live_pipeline_objects();
  for (const std::uint32_t cube_size : {0U, 32U}) {
    for (const Kind kind : kKinds) {
      long n = 0;
      for (;; ++n) {
        ASSERT_LT(n, 1000);
        const Observed before = observe(effect);
        faults::arm(kind, n);
        Result<SkyProbe> made = SkyProbe::create(effect, SkyProbeDesc{2, cube_size});
        const bool failed = faults::disarm();
        ASSERT_EQ(made.ok(), !failed) << n;
        if (!failed) {
          faults::arm(Kind::host, 0);
          const bool recorded = made.value().record(kCommands, {}).ok();
          EXPECT_FALSE(faults::disarm()) << "recording allocates";
          EXPECT_TRUE(recorded);
          break;
        }
        EXPECT_EQ(made.error().code, ErrorCode::out_of_memory) << n;
        EXPECT_FALSE(made.error().message.empty()) << n;
        expect_same(before, observe(effect), "sky probe " + std::to_string(n));
        EXPECT_EQ(faults::live_objects(), objects) << n;
        EXPECT_EQ(faults::live_pipeline_objects(), pipelines) << n;
      }
      EXPECT_GT(n, kind == Kind::vulkan ? 8 : 3);
      print_count("SkyProbe::create with a cube map of " + std::to_string(cube_size), kind, n);
      EXPECT_EQ(faults::live_objects(), objects);
    }
  }
}

TEST(EffectFaults, ParametersAreRefusedAtEveryAllocation) {
  for (const Built built : {Built::not_at_all, Built::in_part, Built::completely}) {
    const std::string name = "set_params, tables built " + std::to_string(static_cast<int>(built));
    refuse_everywhere(
        name, built, [](Effect& effect) { return effect.set_params(other_params()); }, 60, 10);
  }
  // Return to the parameters of the finished tables during a build for others.
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

// Limits and parameters change in one step. Fixed settings cannot change.
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

TEST(EffectFaults, CloudsAreRefusedAtEveryAllocation) {
  const auto allow = [](Effect& effect) {
    EffectDesc desc = effect.desc();
    desc.clouds = true;
    return effect.set_params(effect.params(), desc);
  };
  refuse_everywhere("clouds", Built::completely, allow, 4, 1);
  // A frame with clouds then needs no further pipeline.
  Effect effect = make(Built::completely);
  ASSERT_OK(allow(effect));
  FrameInputs inputs = fake_frame();
  inputs.clouds.map.view = number<VkImageView>(1000010);
  EXPECT_OK(effect.record(kCommands, inputs));
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
        print_count(name, Kind::host, n);
        return;
      }
    }
  };
  survives("query_memory of a sky probe", [&] {
    return SkyProbe::query_memory(faults::fake_device(), SkyProbeDesc{2, 32}).ok();
  });
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
           effect.timings(0).empty() && effect.precompute_timings().empty() && effect.table_bytes() > 0;
  });
}

// Frames without cascades need no pipelines except those that set_params() created.
TEST(EffectFaults, RecordingMakesNoPipeline) {
  Effect effect = make(Built::completely);
  FrameInputs inputs = fake_frame();
  inputs.cascades = {};
  const std::size_t before = faults::live_pipeline_objects();
  ASSERT_OK(effect.record(kCommands, inputs));
  EXPECT_EQ(faults::live_pipeline_objects(), before);
}

// With EffectDesc::table_pipelines_later, the first record_precompute() makes the pipelines. An error there records
// nothing, and the call can be repeated.
TEST(EffectFaults, TablePipelinesCanBeMadeLater) {
  EffectDesc desc = small_desc();
  std::size_t at_once = 0;
  {
    const Result<Effect> effect = Effect::create(faults::fake_device(), desc, small_params());
    ASSERT_OK(effect);
    at_once = faults::live_pipeline_objects();
  }
  desc.table_pipelines_later = true;
  for (const Kind kind : {Kind::vulkan, Kind::host}) {
    Result<Effect> effect = Effect::create(faults::fake_device(), desc, small_params());
    ASSERT_OK(effect);
    EXPECT_LT(faults::live_pipeline_objects() + 12, at_once);
    long n = 0;
    for (;; ++n) {
      faults::forget_commands();
      faults::arm(kind, n);
      const Result<Progress> recorded = effect.value().record_precompute(kCommands, 3);
      if (!faults::disarm()) {
        ASSERT_OK(recorded);
        break;
      }
      ASSERT_FALSE(recorded.ok()) << n;
      EXPECT_EQ(recorded.error().code, ErrorCode::out_of_memory);
      EXPECT_EQ(effect.value().precompute_progress().done, 0U);
    }
    EXPECT_GT(n, 4);  // fewer than the calls, because pipelines made before an error are retained
    EXPECT_EQ(effect.value().precompute_progress().done, 3U);
    EXPECT_EQ(faults::live_pipeline_objects(), at_once);
  }
}

}  // namespace
}  // namespace tyndall
