// Changes after the creation of an effect: parameters that need other pipelines, and other limits.
#include <cmath>

#include "effect_frame.hpp"

namespace tyndall {
namespace {

class EffectChanges : public GpuTest {};

// Pipelines that are created on demand give the same picture as those created with the effect, and can be prepared.
TEST_F(EffectChanges, MissingPipelinesAreCreatedOnRequest) {
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  Result<Effect> effect = Effect::create(info(), desc_for(frame), with_technique(Technique::epipolar));
  ASSERT_OK(effect);
  const Result<Progress> none = effect.value().prepare_pipelines(0);
  ASSERT_OK(none);
  const std::uint32_t first = none.value().done;  // created with the effect
  ASSERT_OK(effect.value().set_params(with_technique(Technique::brute_force)));
  const Result<Progress> both = effect.value().prepare_pipelines(0);
  ASSERT_OK(both);
  // Brute force reads order 1 from the tables or, where they fail below sea level, integrates it.
  constexpr std::uint32_t kOfBruteForce = 2;
  EXPECT_EQ(both.value().done, first + kOfBruteForce);
  const Result<Progress> some = effect.value().prepare_pipelines(3);
  ASSERT_OK(some);
  EXPECT_EQ(some.value().done, first + kOfBruteForce + 3U);
  const Result<Progress> all = effect.value().prepare_pipelines();
  ASSERT_OK(all);
  EXPECT_TRUE(all.value().complete());
  EXPECT_EQ(all.value().total, some.value().total);
  // All pipelines exist now, so no parameters increase the count.
  for (const MediumKind medium : {MediumKind::atmosphere, MediumKind::homogeneous}) {
    for (const std::uint32_t downscale : {1U, 2U, 4U}) {
      Params params = with_technique(Technique::epipolar);
      params.scattering.medium = medium;
      params.scattering.downscale = downscale;
      ASSERT_OK(effect.value().set_params(params));
    }
  }
  const Result<Progress> after = effect.value().prepare_pipelines(0);
  ASSERT_OK(after);
  EXPECT_EQ(after.value().done, all.value().total);
}

// After a change of limits, the effect has the memory and the picture of one that was created with these limits.
TEST_F(EffectChanges, LimitsChange) {
  const TestFrame frame = small_frame();
  Result<FrameImages> images = FrameImages::create(host(), frame, OutputFormat::rgba32f);
  ASSERT_OK(images);
  Params params = with_technique(Technique::epipolar);
  params.scattering.single = SingleScattering::integration;  // needs no tables
  params.scattering.multiple = MultipleScattering::none;
  const EffectDesc desc = desc_for(frame);
  EffectDesc small = desc;
  small.max_extent = {8, 8};
  small.max_cascades = 1;
  small.max_shadow_resolution = 64;
  Result<Effect> grown = Effect::create(info(), small, params);
  Result<Effect> whole = Effect::create(info(), desc, params);
  ASSERT_OK(grown);
  ASSERT_OK(whole);
  EXPECT_FALSE(grown.value().set_limits({0, 8}, 1, 64).ok());
  ASSERT_OK(grown.value().set_limits(desc.max_extent, desc.max_cascades, desc.max_shadow_resolution));
  std::vector<std::byte> bytes[2];
  for (int i = 0; i < 2; ++i) {
    Effect& effect = i == 0 ? grown.value() : whole.value();
    for (std::uint64_t k = 0; k < 4; ++k) {  // until the buffers of the first limits are freed
      FrameInputs inputs = images.value().inputs(frame);
      inputs.frame_index = k;
      ASSERT_OK(host().run([&](VkCommandBuffer cmd) { return effect.record(cmd, inputs); }));
    }
    Result<std::vector<std::byte>> output = images.value().output_bytes(host());
    ASSERT_OK(output);
    bytes[i] = output.value();
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  EXPECT_EQ(grown.value().memory().persistent, whole.value().memory().persistent);
  EXPECT_EQ(grown.value().memory().transient, whole.value().memory().transient);
}

}  // namespace
}  // namespace tyndall
