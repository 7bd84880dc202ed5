// Recording allocates no memory on the host, nor do changes of parameters that affect only the next frame's constants.
#include <atomic>
#include <cstdlib>
#include <new>
#include <numbers>
#include <string>

#include "effect_frame.hpp"
#include "tyndall/phase_table.hpp"
#include "tyndall/sky_probe.hpp"

namespace {
std::atomic<std::size_t> allocations = 0;
}  // namespace

// Counts every allocation with `new` in the program. The driver uses malloc for its own allocations. Not inlined,
// because GCC 12 would report mismatched allocation and release.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  void* const made = std::malloc(size > 0 ? size : 1);
  if (made == nullptr) throw std::bad_alloc();
  return made;
}
// As in the C++ library. The version of the address sanitizer returns memory that free() must not receive.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return ::operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
[[gnu::noinline]] void operator delete(void* pointer) noexcept { std::free(pointer); }
[[gnu::noinline]] void operator delete(void* pointer, std::size_t) noexcept { std::free(pointer); }

namespace tyndall {
namespace {

// Returns a phase function that is the same in all directions.
std::shared_ptr<const PhaseTable> phase_table() {
  const double angles[] = {0.0, 90.0, 180.0}, wavelengths[] = {400.0, 700.0};
  const std::vector<double> values(6, 0.25 / std::numbers::pi);
  return PhaseTable::create(angles, wavelengths, values).value();
}

// With phase functions that shaders read from rows.
void expect_no_allocations_of_sky_probes(gpu::Host& host, Effect& effect, const Sun& sun) {
  Result<SkyProbe> probe = SkyProbe::create(effect, SkyProbeDesc{2, 32});
  ASSERT_OK(probe);
  for (const MiePhase phase : {MiePhase::draine, MiePhase::table}) {
    Params params = effect.params();
    params.atmosphere.mie_phase = phase;
    params.phase_table = phase_table();
    ASSERT_OK(effect.set_params(params));
    ASSERT_OK(host.run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> built = effect.record_precompute(cmd, 100'000);
      if (!built.ok()) return built.error();
      SkyProbeInputs at;
      at.sun = sun;
      const std::size_t before = allocations;
      const Result<Progress> recorded = probe.value().record(cmd, at);
      EXPECT_EQ(allocations, before);
      return recorded.ok() ? Result<void>() : recorded.error();
    }));
  }
}

// Runs without the validation layer, because it allocates memory itself.
TEST(EffectAllocation, RecordingAllocatesNothing) {
  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({});
  ASSERT_TRUE(host.ok()) << "the GPU tests need a Vulkan 1.3 device: " << host.error().message;
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(*host.value(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  EffectDesc desc = desc_for(frame);
  desc.timings = true;
  desc.counters = true;
  const gpu::Device& device = host.value()->device();
  DeviceInfo info;
  info.instance = device.instance;
  info.physical_device = device.physical_device;
  info.device = device.device;
  info.get_instance_proc_addr = host.value()->get_instance_proc_addr();
  info.message = [](void*, Severity, std::string_view) {};
  Result<Effect> effect = Effect::create(info, desc, {});
  ASSERT_OK(effect);
  FrameInputs inputs = images.value().inputs(frame);
  for (std::uint64_t i = 0; i < 8; ++i) {
    // Both techniques, and every pass of epipolar sampling.
    Params params = with_technique(i < 6 ? Technique::epipolar : Technique::brute_force);
    params.shadows.cascade_processing = static_cast<CascadeProcessing>(i % 3);
    params.epipolar.show_sampling = i >= 3;
    params.epipolar.correct_depth_breaks = i >= 3;
    if (i >= 6) params.atmosphere.mie_phase = MiePhase::draine;
    ASSERT_OK(effect.value().set_params(params));
    inputs.frame_index = i;
    std::size_t during = 1;
    ASSERT_OK(host.value()->run([&](VkCommandBuffer cmd) -> Result<void> {
      const std::size_t before = allocations;
      const Result<Progress> built = effect.value().record_precompute(cmd, 3);
      Result<void> recorded = effect.value().record(cmd, inputs);
      during = allocations - before;
      if (!built.ok()) return built.error();
      return recorded;
    }));
    EXPECT_EQ(during, 0U) << i;
    const std::size_t before = allocations;
    EXPECT_FALSE(effect.value().timings(i).empty());
    EXPECT_EQ(allocations, before);
  }
  expect_no_allocations_of_sky_probes(*host.value(), effect.value(), inputs.sun);
  // A change of parameters that only affect the constants of the next frame does not allocate either.
  Params other_constants = effect.value().params();
  other_constants.scattering.scale *= 2.0F;
  other_constants.epipolar.refinement_threshold *= 2.0F;
  const std::size_t before_change = allocations;
  const bool changed = effect.value().set_params(other_constants).ok();
  EXPECT_EQ(allocations, before_change);
  EXPECT_TRUE(changed);
  // Saving tables to a buffer and loading them do not allocate.
  Result<Effect> other = Effect::create(info, desc, {});
  ASSERT_OK(other);
  const Result<gpu::Buffer> saved =
      gpu::create_buffer(device, "saved", other.value().table_bytes(),
                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::device);
  ASSERT_OK(saved);
  ASSERT_OK(host.value()->run([&](VkCommandBuffer cmd) -> Result<void> {
    const VkBuffer buffer = saved.value().buffer.get();
    const std::size_t before = allocations;
    Result<void> recorded = other.value().record_load_tables(cmd, buffer);
    if (recorded.ok()) {
      gpu::barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, VK_PIPELINE_STAGE_TRANSFER_BIT, 0);
      recorded = other.value().record_save_tables(cmd, buffer);
    }
    EXPECT_EQ(allocations, before);
    return recorded;
  }));
  EXPECT_TRUE(other.value().precompute_progress().complete());
  // Verify that allocations are counted.
  const std::size_t before = allocations;
  delete new int(3);
  const std::string long_text(1000, 'x');
  EXPECT_GT(allocations, before) << long_text;
}

}  // namespace
}  // namespace tyndall
