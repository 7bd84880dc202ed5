// scattering.downscale: upscaled pictures are similar to those at full resolution, in both media.
#include <cmath>
#include <functional>

#include "shared_effect.hpp"

namespace tyndall {
namespace {

using Downscale = SharedEffect;

// Returns a scene whose picture is large enough for half the number of slices and samples.
BoxScene wide() {
  BoxScene scene;
  scene.extent = {320, 180};
  return scene;
}

Params params_of(MediumKind medium, std::uint32_t downscale) {
  Params params = small_params();
  params.epipolar.slices = 256;
  params.epipolar.samples = 128;
  params.scattering.medium = medium;
  params.scattering.downscale = downscale;
  return params;
}

TEST_F(Downscale, IsLikeFullResolution) {
  struct Case {
    const char* name;
    std::function<void(BoxScene&)> change;
    double half_db, quarter_db;  // minimum PSNR against downscale 1
  };
  const Case cases[] = {
      {"towards the sun", [](BoxScene&) {}, 43.0, 38.0},
      {"sun in view",
       [](BoxScene& s) {
         s.sun.in_view = true;
         s.sun.x = 0.2;
         s.sun.y = -0.4;
         s.pitch_deg = 8.0;
       },
       43.0, 38.0},
      {"sun behind",
       [](BoxScene& s) {
         s.sun.in_view = true;
         s.sun.behind = true;
         s.pitch_deg = -6.0;
       },
       43.0, 38.0},
      {"nothing but planet and sky",
       [](BoxScene& s) {
         s.buildings = s.ground = false;
         s.cascades = 0;
       },
       50.0, 44.0},
      {"an odd size",
       [](BoxScene& s) {
         s.extent = {251, 141};
       },
       43.0, 38.0},
  };
  for (const MediumKind medium : {MediumKind::atmosphere, MediumKind::homogeneous}) {
    const std::string of = medium == MediumKind::atmosphere ? "atmosphere, " : "homogeneous, ";
    for (const Case& c : cases) {
      BoxScene scene = wide();
      c.change(scene);
      show(scene);
      const Picture full = draw(params_of(medium, 1), of + c.name);
      const Picture truth = draw(by_brute_force(params_of(medium, 1)), of + c.name + ", brute force");
      RecordProperty("dB: " + of + c.name, hundredths(compare(full, truth, scene.extent).psnr_db) + " of brute force");
      for (const std::uint32_t downscale : {2U, 4U}) {
        const std::string name = of + c.name + ", downscale " + std::to_string(downscale);
        const Picture picture = draw(params_of(medium, downscale), name);
        const Likeness likeness = compare(picture, full, scene.extent);
        EXPECT_GE(likeness.psnr_db, downscale == 2 ? c.half_db : c.quarter_db) << name;
        RecordProperty("dB: " + name, hundredths(likeness.psnr_db) + ", of brute force " +
                                          hundredths(compare(picture, truth, scene.extent).psnr_db) + ", corrected " +
                                          std::to_string(counters().pixels_corrected));
      }
    }
  }
}

TEST_F(Downscale, OrderOfCascadesChangesNothing) {
  show(wide());
  for (const MediumKind medium : {MediumKind::atmosphere, MediumKind::homogeneous}) {
    for (const std::uint32_t downscale : {2U, 4U}) {
      Params params = params_of(medium, downscale);
      const Picture at_once = draw(params, "single-pass");
      for (const CascadeProcessing processing :
           {CascadeProcessing::multi_pass, CascadeProcessing::multi_pass_instanced}) {
        params.shadows.cascade_processing = processing;
        const Likeness likeness = compare(draw(params, "in turn"), at_once, frame().extent);
        EXPECT_LE(likeness.worst_relative_error, 1e-3) << downscale << " " << static_cast<int>(processing);
        RecordProperty("worst: in turn, " + std::to_string(downscale) + " " +
                           std::to_string(static_cast<int>(processing)) +
                           (medium == MediumKind::atmosphere ? " atmosphere" : " homogeneous"),
                       std::to_string(likeness.worst_relative_error));
      }
    }
  }
}

TEST_F(Downscale, CountersReportTheSavedWork) {
  show(wide());
  draw(params_of(MediumKind::homogeneous, 1), "full");
  const Counters full = counters();
  draw(params_of(MediumKind::homogeneous, 2), "half");
  const Counters half = counters();
  EXPECT_LT(half.samples_marched, full.samples_marched / 2);
  EXPECT_GT(half.samples_marched, full.samples_marched / 16);
  EXPECT_LT(half.pixels_corrected, std::uint64_t{320} * 180 / 20);
  // Brute force computes every pixel, independent of scattering.downscale.
  const Picture brute = draw(by_brute_force(params_of(MediumKind::homogeneous, 1)), "brute force");
  EXPECT_EQ(draw(by_brute_force(params_of(MediumKind::homogeneous, 4)), "brute force, 4"), brute);
}

// An object one pixel wide has no buffer pixel at its depth. It is interpolated from the slices, or marched.
TEST_F(Downscale, PostsOfOnePixelAreComposedAtTheirDepth) {
  BoxScene scene = wide();
  scene.buildings = false;
  TestFrame frame = frame_of(scene);
  const auto behind = frame.distance_m;
  const auto post = [](std::uint32_t x) { return x % 16 == 3; };
  frame.distance_m = [=](std::uint32_t x, std::uint32_t y) { return post(x) ? 300.0 : behind(x, y); };
  frame.background = Vec3(0.0F);
  show(frame);
  for (const MediumKind medium : {MediumKind::atmosphere, MediumKind::homogeneous}) {
    const Picture truth = draw(by_brute_force(params_of(medium, 1)), "brute force");
    for (const std::uint32_t downscale : {2U, 4U}) {
      const Picture picture = draw(params_of(medium, downscale), "posts");
      double worst = 0.0;
      for (std::size_t i = 0; i < picture.size(); ++i) {
        if (post(static_cast<std::uint32_t>(i % scene.extent.width)))
          worst = std::max(worst, relative_error(picture[i], truth[i]));
      }
      EXPECT_LE(worst, 0.3) << downscale;
      RecordProperty("worst of posts: " + std::to_string(downscale) +
                         (medium == MediumKind::atmosphere ? " atmosphere" : " homogeneous"),
                     std::to_string(worst));
    }
  }
}

TEST_F(Downscale, OnlyFactorsOneTwoAndFourAreAccepted) {
  for (const std::uint32_t downscale : {0U, 3U, 5U, 8U}) {
    Params params = small_params();
    params.scattering.downscale = downscale;
    const Result<void> taken = effect().set_params(params);
    ASSERT_FALSE(taken.ok());
    EXPECT_NE(taken.error().message.find("scattering.downscale"), std::string::npos) << taken.error().message;
  }
}

TEST_F(Downscale, QueriedMemoryIsAllocatedMemory) {
  for (const std::uint32_t downscale : {1U, 2U, 4U}) {
    const Params params = params_of(MediumKind::homogeneous, downscale);
    ASSERT_OK(effect().set_params(params));
    const Result<MemoryUsage> expected = query_memory(info(), desc(), params);
    ASSERT_OK(expected);
    EXPECT_EQ(effect().memory().persistent, expected.value().persistent) << downscale;
  }
}

}  // namespace
}  // namespace tyndall
