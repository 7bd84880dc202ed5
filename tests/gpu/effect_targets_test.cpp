// The variant of the passes for GPUs, run on a CPU device that pretends to be a GPU: it draws the same picture as the
// variant for CPU devices.
#include <functional>

#include "faults.hpp"
#include "shared_effect.hpp"

namespace tyndall {
namespace {

class EffectTargets : public SharedEffect {
 protected:
  // Creates an effect whose device reports itself as a GPU.
  std::optional<Effect> effect_for_gpu(const EffectDesc& desc) {
    faults::set_properties([](VkPhysicalDeviceProperties2& properties) {
      properties.properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    });
    DeviceInfo gpu = info();
    gpu.get_instance_proc_addr = faults::get_instance_proc_addr;
    Result<Effect> made = Effect::create(gpu, desc, small_params());
    EXPECT_OK(made);
    if (!made.ok()) return {};
    std::optional<Effect> out(std::move(made).value());
    EXPECT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> built = out->record_precompute(cmd);
      if (!built.ok()) return built.error();
      return {};
    }));
    return out;
  }
  void TearDown() override {
    own_effect_.reset();
    faults::set_properties({});
    SharedEffect::TearDown();
  }
};

TEST_F(EffectTargets, DrawTheSamePicture) {
  std::optional<Effect> on_gpu = effect_for_gpu(desc());
  ASSERT_TRUE(on_gpu.has_value());
  BoxScene scene;
  scene.extent = {161, 91};
  show(scene);
  // `greatest` is the largest relative error of a pixel. Brute force computes the same numbers, but a compiler may
  // order operations differently. Epipolar sampling marches and interpolates the same samples, but blends them in
  // blocks of another size. In so small a picture, blocks next to an edge differ visibly, but few pixels are in such
  // blocks.
  constexpr double kMean = 1e-3;
  constexpr double kMinPsnr = 50.0;
  const auto compare_targets = [&](const char* name, double greatest, const std::function<void(Params&)>& change) {
    Params params = small_params();
    params.scattering.single = SingleScattering::integration;
    change(params);
    const Picture on_cpu = draw(params, name);
    const Counters counted = counters();
    std::swap(own_effect_, on_gpu);
    const Picture picture = draw(params, std::string(name) + " on a GPU");
    EXPECT_EQ(counters().samples_marched, counted.samples_marched) << name;
    std::swap(own_effect_, on_gpu);
    const Likeness likeness = compare(picture, on_cpu, scene.extent);
    EXPECT_LE(likeness.worst_relative_error, greatest) << name;
    EXPECT_LE(likeness.mean_relative_error, kMean) << name;
    EXPECT_GE(likeness.psnr_db, kMinPsnr) << name;
    RecordProperty(name, std::to_string(likeness.worst_relative_error) + " mean " +
                             std::to_string(likeness.mean_relative_error) + " dB " + hundredths(likeness.psnr_db));
  };
  constexpr double kRounding = 1e-5;
  constexpr double kBlocks = 0.15;
  compare_targets("brute force", kRounding, [](Params& p) { p.scattering.technique = Technique::brute_force; });
  compare_targets("without the atmosphere", 0.0, [](Params& p) { p.scattering.enabled = false; });
  compare_targets("epipolar", kBlocks, [](Params&) {});
  compare_targets("tables", kBlocks, [](Params& p) {
    p.scattering.single = SingleScattering::table;
    p.scattering.multiple = MultipleScattering::occluded;
  });
  compare_targets("homogeneous", kBlocks, [](Params& p) { p.scattering.medium = MediumKind::homogeneous; });
  compare_targets("half resolution", kBlocks, [](Params& p) { p.scattering.downscale = 2; });
  compare_targets("few slices", kBlocks, [](Params& p) { p.epipolar.slices = 48; });
  compare_targets("side by side", kBlocks, [](Params& p) {
    p.shadows.cascade_processing = CascadeProcessing::multi_pass_instanced;
    p.epipolar.min_max_format = MinMaxFormat::float32;
  });
  compare_targets("corrected", kBlocks, [](Params& p) { p.epipolar.correct_depth_breaks = true; });
}

// On GPUs the whole effect has a scope, which precedes those of its passes.
TEST_F(EffectTargets, MeasureTheWholeEffectOnGpus) {
  EffectDesc timed = desc();
  timed.timings = true;
  own_effect_ = effect_for_gpu(timed);
  ASSERT_TRUE(own_effect_.has_value());
  show(BoxScene{});
  draw(small_params(), "timed");
  const std::span<const PassTiming> times = effect().timings(0);
  ASSERT_GT(times.size(), 5U);
  EXPECT_STREQ(times[0].name, "effect");
  EXPECT_STREQ(times[1].name, "slice_end_points");
  EXPECT_GT(times[0].gpu_ms, 0.0);
  for (const PassTiming& pass : times) EXPECT_GE(pass.gpu_ms, 0.0) << pass.name;
}

}  // namespace
}  // namespace tyndall
