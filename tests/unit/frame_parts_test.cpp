// The two parts in which a frame can be recorded, as lists of steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string_view>

#include "effect/frame_steps.hpp"

namespace tyndall {
namespace {

// Returns whether a step uses another image of the caller than the depth.
bool needs_more_than_depth(const Step& step) {
  const Uses uses = uses_of(step);
  return std::any_of(uses.begin(), uses.end(), [](const Use& use) {
    return info_of(use.resource).lifetime == Lifetime::caller && use.resource != Resource::scene_depth;
  });
}

bool places_samples(const Step& step) {
  const std::string_view name = step.name;
  return name.starts_with("slice_") || name == "refine_samples";
}

void expect_parts(const FrameSteps& steps, bool epipolar) {
  const std::span<const Step> first = steps.of(FramePart::first);
  const std::span<const Step> second = steps.of(FramePart::second);
  // Together they are the whole frame, in its order.
  ASSERT_EQ(first.data(), steps.begin());
  ASSERT_EQ(first.data() + first.size(), second.data());
  ASSERT_EQ(second.data() + second.size(), steps.end());
  ASSERT_EQ(steps.of(FramePart::whole).size(), steps.size());
  ASSERT_TRUE(std::none_of(first.begin(), first.end(), needs_more_than_depth));
  // All passes that place samples are in the first part.
  ASSERT_TRUE(std::none_of(second.begin(), second.end(), places_samples));
  ASSERT_EQ(std::any_of(first.begin(), first.end(), places_samples), epipolar);
}

TEST(FrameParts, TheFirstNeedsTheDepthOnly) {
  for (const Technique technique : {Technique::epipolar, Technique::brute_force, Technique::froxels}) {
    for (std::uint32_t bits = 0; bits < 64; ++bits) {
      const auto on = [bits](std::uint32_t i) { return (bits >> i & 1U) != 0; };
      Params params;
      params.scattering.technique = technique;
      params.froxels.enabled = on(0);
      params.epipolar.min_max_tree = on(1);
      params.scattering.downscale = on(2) ? 2 : 1;
      params.scattering.light_shafts = on(3);
      params.scattering.enabled = on(4);
      params.shadows.cascade_processing =
          on(5) ? CascadeProcessing::multi_pass_instanced : CascadeProcessing::single_pass;
      for (const bool counters : {false, true}) {
        EffectDesc desc;
        desc.counters = counters;
        for (const std::uint32_t cascades : {0U, 4U}) {
          expect_parts(frame_steps(desc, params, {{640, 360}, cascades, 0, false}),
                       technique == Technique::epipolar && params.scattering.enabled);
        }
      }
    }
  }
}

}  // namespace
}  // namespace tyndall
