// Recording creates no Vulkan object, allocates no memory and takes no lock, in any mode: on a fake device, every such
// call of the library is watched.
#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <mutex>
#include <string>

#include "../sanitizers.hpp"
#include "small_effect.hpp"
#include "tyndall/sky_probe.hpp"

namespace {
std::atomic<long> locks = 0;
}  // namespace

// Counts the locks of the whole program. The thread sanitizer has a function of its own.
#ifndef TYNDALL_THREAD_SANITIZER
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Function = int (*)(pthread_mutex_t*);
  static const auto lock = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++locks;
  return lock(mutex);
}
#endif

namespace tyndall {
namespace {

using faults::Kind;

// Calls `record` once with each kind of call failing if it occurs, and expects that none does.
template <typename Record>
void expect_nothing_created(const std::string& where, const Record& record) {
  for (const Kind kind : {Kind::vulkan, Kind::host}) {
    const long before = locks;
    faults::arm(kind, 0);
    const bool ok = record();
    const bool created = faults::disarm();
    const long taken = locks - before;
    EXPECT_TRUE(ok) << where;
    EXPECT_FALSE(created) << where << (kind == Kind::host ? ": operator new" : ": a Vulkan object");
    EXPECT_EQ(taken, 0) << where << ": locks";
  }
}

std::vector<Params> modes() {
  std::vector<Params> out(9, small_params());
  out[1].scattering.technique = Technique::brute_force;
  out[2].shadows.cascade_processing = CascadeProcessing::multi_pass;
  out[3].shadows.cascade_processing = CascadeProcessing::multi_pass_instanced;
  out[4].scattering.downscale = 2;
  out[5].scattering.enabled = false;
  out[6].scattering.medium = MediumKind::homogeneous;
  out[7].scattering.multiple = MultipleScattering::occluded;
  out[7].epipolar.correct_depth_breaks = true;
  out[8].epipolar.show_sampling = true;
  out[8].scattering.single = SingleScattering::integration;
  return out;
}

TEST(EffectRecording, FramesCreateNothingInAnyMode) {
  Effect effect = make(Built::completely);
  std::uint64_t frame = 4;
  for (std::size_t i = 0; i < modes().size(); ++i) {
    ASSERT_OK(effect.set_params(modes()[i]));
    FrameInputs inputs = fake_frame();
    for (const bool cascades : {true, false}) {
      if (!cascades) inputs.cascades = {};
      expect_nothing_created("mode " + std::to_string(i), [&] {
        inputs.frame_index = frame++;
        return effect.record(kCommands, inputs).ok();
      });
    }
  }
}

TEST(EffectRecording, TablesCreateNothing) {
  Effect effect = make(Built::not_at_all);
  expect_nothing_created("record_precompute", [&] { return effect.record_precompute(kCommands, 5).ok(); });
  expect_nothing_created("record_precompute", [&] { return effect.record_precompute(kCommands).ok(); });
  const auto buffer = number<VkBuffer>(1000007);
  expect_nothing_created("record_save_tables", [&] { return effect.record_save_tables(kCommands, buffer).ok(); });
  Effect other = make(Built::in_part);
  expect_nothing_created("record_load_tables", [&] { return other.record_load_tables(kCommands, buffer).ok(); });
}

TEST(EffectRecording, SkyProbesCreateNothing) {
  Effect effect = make(Built::completely);
  Result<SkyProbe> probe = SkyProbe::create(effect, SkyProbeDesc{2, 32});
  ASSERT_OK(probe);
  for (const std::uint32_t budget : {2U, UINT32_MAX}) {
    expect_nothing_created("SkyProbe::record", [&] { return probe.value().record(kCommands, {}, budget).ok(); });
  }
}

// Each allocation of SkyProbe::create() fails once. It leaks nothing, and the effect stays as it was.
TEST(EffectRecording, SkyProbesAreRefusedAtEveryAllocation) {
  for (const Kind kind : {Kind::vulkan, Kind::host}) {
    long n = 0;
    for (;; ++n) {
      ASSERT_LT(n, 300);
      Effect effect = make(Built::completely);
      const std::size_t objects = faults::live_objects();
      faults::arm(kind, n);
      const Result<SkyProbe> made = SkyProbe::create(effect, SkyProbeDesc{2, 32});
      const bool failed = faults::disarm();
      ASSERT_EQ(made.ok(), !failed) << n;
      if (!failed) break;
      EXPECT_EQ(made.error().code, ErrorCode::out_of_memory) << n;
      EXPECT_EQ(faults::live_objects(), objects) << n;
    }
    EXPECT_GT(n, 5) << "verify that allocations have failed";
  }
  EXPECT_EQ(faults::live_objects(), 0U);
}

TEST(EffectRecording, WhatIsWatchedIsSeen) {
  const long before = locks;
  std::mutex mutex;
  mutex.lock();
  mutex.unlock();
#ifndef TYNDALL_THREAD_SANITIZER
  EXPECT_GT(locks, before);
#else
  EXPECT_EQ(locks, before);
#endif
  // Parameters that need other pipelines create objects and allocate.
  for (const Kind kind : {Kind::vulkan, Kind::host}) {
    Effect effect = make(Built::completely);
    faults::arm(kind, 0);
    EXPECT_FALSE(effect.set_params(other_params()).ok());
    EXPECT_TRUE(faults::disarm());
  }
}

// Tables that are completed between two slices: the update starts again, because its parts must come from one set.
TEST(EffectRecording, UpdatesOfTheSkyProbeNeverMixTables) {
  Effect effect = make(Built::completely);
  Result<SkyProbe> probe = SkyProbe::create(effect, 8);
  ASSERT_OK(probe);
  const auto done = [&](std::uint32_t budget) {
    const Result<Progress> recorded = probe.value().record(kCommands, {}, budget);
    EXPECT_OK(recorded);
    return recorded.ok() ? recorded.value().done : 0U;
  };
  EXPECT_EQ(done(3), 3U);
  Params params = small_params();
  params.scattering.color = ColorMode::spectral;
  ASSERT_OK(effect.set_params(params));
  ASSERT_OK(effect.record_precompute(kCommands, 2));
  EXPECT_EQ(done(1), 4U) << "the tables of the update are still in use";
  ASSERT_OK(effect.record_precompute(kCommands));
  EXPECT_EQ(done(1), 1U) << "the update has begun again";
  params.planet.ground_albedo = Vec3(0.9F);
  ASSERT_OK(effect.set_params(params));
  ASSERT_OK(effect.record_precompute(kCommands));
  EXPECT_EQ(done(2), 2U) << "the update has begun again";
}

}  // namespace
}  // namespace tyndall
