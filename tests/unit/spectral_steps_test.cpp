// The variants of passes for scattering.color = spectral.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "effect/frame_steps.hpp"
#include "effect/table_plan.hpp"
#include "effect/table_steps.hpp"

namespace tyndall {
namespace {

EffectDesc full_desc() {
  EffectDesc desc;
  desc.counters = true;
  desc.shadow_colors = true;
  return desc;
}

// Returns settings with all passes of a frame.
std::vector<Params> settings() {
  std::vector<Params> out(7);
  out[1].scattering.downscale = 2;
  out[2].scattering.technique = Technique::brute_force;
  out[3].scattering.medium = MediumKind::homogeneous;
  out[4].shadows.cascade_processing = CascadeProcessing::multi_pass_instanced;
  out[4].epipolar.show_sampling = true;
  out[5].scattering.enabled = false;
  out[6].scattering.technique = Technique::froxels;
  return out;
}

Params in_color(Params params, ColorMode color) {
  params.scattering.color = color;
  return params;
}

// Passes that carry light have variants for both values of scattering.color, with the same bindings and constants.
// Memory and barriers are planned for one of them.
class SpectralSteps : public testing::Test {
 protected:
  void compare(const gpu::Shader& rgb, const gpu::Shader& spectral) {
    if (&rgb == &spectral) return;
    variants_.insert(rgb.name);
    EXPECT_EQ(std::string(spectral.name).find("_spectral") != std::string::npos, true) << spectral.name;
    const auto resources = bound_resources(rgb);
    const auto others = bound_resources(spectral);
    EXPECT_TRUE(std::is_permutation(resources.begin(), resources.end(), others.begin(), others.end())) << rgb.name;
    EXPECT_TRUE(std::is_permutation(rgb.constants.begin(), rgb.constants.end(), spectral.constants.begin(),
                                    spectral.constants.end()))
        << rgb.name;
    EXPECT_TRUE(std::equal(rgb.local_size, rgb.local_size + 3, spectral.local_size)) << rgb.name;
  }
  std::set<std::string> variants_;
};

TEST_F(SpectralSteps, OfFrames) {
  for (const Target target : {Target::cpu, Target::gpu}) {
    variants_.clear();
    for (const Params& params : settings()) {
      FrameShape shape;
      shape.extent = {640, 360};
      shape.cascades = 4;
      shape.shadow_colors = true;
      shape.target = target;
      const FrameSteps rgb = frame_steps(full_desc(), in_color(params, ColorMode::rgb), shape);
      const FrameSteps spectral = frame_steps(full_desc(), in_color(params, ColorMode::spectral), shape);
      ASSERT_EQ(rgb.size(), spectral.size());
      for (std::size_t i = 0; i < rgb.size(); ++i) {
        const Step& step = *(rgb.begin() + i);
        if (step.dispatches()) compare(*step.pipeline.shader, *(spectral.begin() + i)->pipeline.shader);
      }
    }
    // compose_froxels, correct_downscaled, correct_pixels, froxels, interpolate_samples, march_per_pixel,
    // march_samples, slice_samples, unwarp, unwarp_pixels, upscale, upscale_pixels
    EXPECT_EQ(variants_.size(), 12U);
  }
}

TEST_F(SpectralSteps, OfTables) {
  Params params;
  params.tables.size = {4, 4, 4, 4};
  const std::vector<Step> rgb = table_steps(params, kAllTables);
  const std::vector<Step> spectral = table_steps(in_color(params, ColorMode::spectral), kAllTables);
  ASSERT_EQ(rgb.size(), spectral.size());
  for (std::size_t i = 0; i < rgb.size(); ++i) compare(*rgb[i].pipeline.shader, *spectral[i].pipeline.shader);
  EXPECT_EQ(variants_.size(), 10U);  // all but the phase matrix
}

TEST(SpectralTables, AreStaleAfterAChangeOfTheMode) {
  const Params rgb;
  EXPECT_EQ(stale_tables(rgb, in_color(rgb, ColorMode::spectral)), kAllTables);
  // At four wavelengths, the tables do not depend on the channels unless coefficients are given for them.
  Params other = in_color(rgb, ColorMode::spectral);
  other.atmosphere.ozone_du = 300.0F;
  Params channels = other;
  channels.atmosphere.wavelengths_nm = {650.0F, 540.0F, 450.0F};
  EXPECT_EQ(stale_tables(other, channels), 0U);
  channels.scattering.color = ColorMode::rgb;
  other.scattering.color = ColorMode::rgb;
  EXPECT_EQ(stale_tables(other, channels), kAllTables);
}

}  // namespace
}  // namespace tyndall
