// Epipolar sampling against brute force for various positions of sun and camera, picture sizes, shadow maps and numbers
// of slices, with the same frame, modes and exposure. Each case has a minimum PSNR, about 3 dB below its value or 40 dB
// if it reaches that. No pixel may be black, negative or not finite. Small pictures are difficult, because their pixels
// are as wide as eight of a large one.
#include <algorithm>
#include <cmath>
#include <functional>

#include "shared_effect.hpp"

namespace tyndall {
namespace {

struct View {
  BoxScene scene;
  double floor_db = 40.0;
};

BoxScene seen(const std::string& name, const std::function<void(BoxScene&)>& change) {
  BoxScene scene;
  scene.name = name;
  change(scene);
  return scene;
}

class Epipolar : public SharedEffect {
 protected:
  // Compares both techniques with in-scattering from the tables, and integrated along the ray.
  void expect_alike_in_both_modes(const std::vector<View>& views) {
    for (const View& view : views) {
      show(view.scene);
      expect_alike(view.scene.name, small_params(), view.floor_db);
      Params integrated = small_params();
      integrated.scattering.single = SingleScattering::integration;
      expect_alike(view.scene.name + ", integrated", integrated, view.floor_db);
    }
  }
};

TEST_F(Epipolar, TheSunMayBeAnywhere) {
  const double pixel = 1.0 / 160.0;  // half a pixel: distance of the outermost pixel centres from the border
  const double line = 1.0 / 90.0;
  std::vector<View> views = {
      {sun_at("straight ahead", 0.0, 0.0, 6.0), 40.0},
      {sun_at("straight behind", 0.0, 0.0, -6.0, true), 43.0},
      {sun_at("behind, beside the picture", 1.7, 0.2, -20.0, true), 47.0},
      {sun_at("left border", -1.0, 0.1, 8.0), 40.0},
      {sun_at("right border", 1.0, -0.2, 8.0), 41.0},
      {sun_at("upper border", 0.3, -1.0, 0.0), 41.0},
      {sun_at("lower border", -0.2, 1.0, 27.0), 42.0},
      {sun_at("upper left corner", -1.0, -1.0, 0.0), 42.0},
      {sun_at("upper right corner", 1.0, -1.0, 0.0), 42.0},
      {sun_at("lower left corner", -1.0, 1.0, 27.0), 42.0},
      {sun_at("lower right corner", 1.0, 1.0, 27.0), 42.0},
      {sun_at("leftmost pixels", -1.0 + pixel, 0.0, 8.0), 43.0},
      {sun_at("corner pixel", 1.0 - pixel, -1.0 + line, 0.0), 43.0},
      {sun_at("beside the picture", 1.4, -0.3, 8.0), 42.0},
      {sun_at("far above", 0.2, -9.0, 0.0), 42.0},
  };
  // At a right angle to the view, w of the epipole is 0.
  views.push_back({seen("exactly at the side",
                        [](BoxScene& s) {
                          s.sun.elevation_deg = 0.0;
                          s.sun.azimuth_deg = 90.0;
                          s.pitch_deg = 0.0;
                        }),
                   46.0});
  views.push_back({seen("in the zenith of a level view",
                        [](BoxScene& s) {
                          s.sun.elevation_deg = 90.0;
                          s.pitch_deg = 0.0;
                        }),
                   40.0});
  views.push_back({seen("nearly at the side",
                        [](BoxScene& s) {
                          s.sun.elevation_deg = 5.0;
                          s.sun.azimuth_deg = 90.001;
                          s.pitch_deg = 0.0;
                        }),
                   48.0});
  views.push_back({seen("below the horizon", [](BoxScene& s) { s.sun.elevation_deg = -2.0; }), 41.0});
  expect_alike_in_both_modes(views);
}

TEST_F(Epipolar, TheCameraMayBeAnywhere) {
  const std::vector<View> views = {
      {seen("on the ground",
            [](BoxScene& s) {
              s.altitude_m = 2.0;
              s.pitch_deg = 15.0;
            }),
       40.0},
      {seen("in a building's shadow",
            [](BoxScene& s) {
              s.altitude_m = 300.0;  // the hovering building and the nearest tower are in front of the sun
              s.sun.azimuth_deg = 353.0;
              s.sun.elevation_deg = 12.0;
              s.pitch_deg = 10.0;
            }),
       40.0},
      // Below sea level, and slightly above it over lower land.
      {seen("by the Dead Sea",
            [](BoxScene& s) {
              s.altitude_m = -428.0;
              s.ground_altitude_m = -430.0;
              s.pitch_deg = -1.0;
            }),
       40.0},
      {seen("above the Dead Sea",
            [](BoxScene& s) {
              s.altitude_m = -130.0;
              s.ground_altitude_m = -430.0;
              s.buildings = false;
              s.pitch_deg = -1.0;
            }),
       47.9},
      {seen("on a dyke",
            [](BoxScene& s) {
              s.altitude_m = 2.0;
              s.ground_altitude_m = -5.0;
              s.buildings = false;
              s.pitch_deg = -2.0;
            }),
       48.0},
      {seen("over a sea floor",
            [](BoxScene& s) {
              s.altitude_m = -2000.0;
              s.ground_altitude_m = -4000.0;
              s.pitch_deg = -10.0;
            }),
       40.0},
      {seen("on a summit",
            [](BoxScene& s) {
              s.altitude_m = 6000.0;
              s.pitch_deg = -12.0;
            }),
       43.0},
      {seen("at 30 km",
            [](BoxScene& s) {
              s.altitude_m = 30000.0;
              s.pitch_deg = -25.0;
              s.far_m = 150000.0;
            }),
       40.0},
  };
  expect_alike_in_both_modes(views);
}

TEST_F(Epipolar, TheLimbMayBeSeenFromSpace) {
  const std::vector<View> views = {
      {seen("limb from 400 km",
            [](BoxScene& s) {
              s.altitude_m = 400000.0;
              s.pitch_deg = -20.0;
              s.far_m = 3.0e6;
              s.tan_half_height = 0.12;
              s.building_size = 60.0;  // shadows of hundreds of kilometres
              s.ground_casts = false;  // a texel of the shadow map spans most of the height of the atmosphere
            }),
       40.0},
      {seen("limb from 400 km, planet not drawn",
            [](BoxScene& s) {
              s.altitude_m = 400000.0;
              s.pitch_deg = -20.0;
              s.tan_half_height = 0.12;
              s.buildings = s.ground = false;
              s.cascades = 0;
            }),
       47.0},
      // Against the sun, the light of the lowest atmosphere changes by a large factor from pixel to pixel.
      {seen("limb against the sun",
            [](BoxScene& s) {
              s.altitude_m = 400000.0;
              s.pitch_deg = -18.0;
              s.tan_half_height = 0.12;
              s.sun.in_view = true;
              s.sun.y = -0.3;
              s.buildings = false;
              s.cascades = 0;
            }),
       40.0},
  };
  expect_alike_in_both_modes(views);
}

TEST_F(Epipolar, TheViewMayShowOnlySkyOrBeVertical) {
  const auto open = [](BoxScene& s) {
    s.buildings = false;
    s.ground = false;
    s.cascades = 0;
  };
  const std::vector<View> views = {
      {seen("no terrain at all",
            [&](BoxScene& s) {
              open(s);
              s.pitch_deg = -8.0;
            }),
       40.0},
      {seen("sky alone",
            [&](BoxScene& s) {
              open(s);
              s.pitch_deg = 40.0;
            }),
       45.0},
      {seen("straight down",
            [](BoxScene& s) {
              s.altitude_m = 9000.0;
              s.pitch_deg = -90.0;
            }),
       44.0},
      {seen("straight up",
            [](BoxScene& s) {
              s.altitude_m = 5.0;
              s.pitch_deg = 90.0;
            }),
       54.0},
  };
  expect_alike_in_both_modes(views);
}

TEST_F(Epipolar, ThePictureMayHaveAnyShapeAndFieldOfView) {
  const std::vector<View> views = {
      {seen("1 x 1",
            [](BoxScene& s) {
              s.extent = {1, 1};
            }),
       57.0},
      {seen("1 x 40",
            [](BoxScene& s) {
              s.extent = {1, 40};
            }),
       42.0},
      {seen("40 x 1",
            [](BoxScene& s) {
              s.extent = {40, 1};
              s.tan_half_height = 0.02;
            }),
       40.0},
      {seen("4096 x 2",
            [](BoxScene& s) {
              s.extent = {4096, 2};
              s.tan_half_height = 0.0004;
            }),
       52.0},
      {seen("portrait",
            [](BoxScene& s) {
              s.extent = {60, 140};
              s.tan_half_height = 0.8;
            }),
       43.0},
      {seen("ultra-wide",
            [](BoxScene& s) {
              s.extent = {320, 40};
              s.tan_half_height = 0.25;
            }),
       40.0},
      {seen("wide angle", [](BoxScene& s) { s.tan_half_height = 2.0; }), 42.0},
      {seen("telescope",
            [](BoxScene& s) {
              s.tan_half_height = 0.01;
              s.pitch_deg = 7.0;
            }),
       57.0},
  };
  expect_alike_in_both_modes(views);
}

TEST_F(Epipolar, ShadowMapsMayHaveAnySizeAndDepth) {
  Params params = small_params();
  params.scattering.single = SingleScattering::integration;
  params.scattering.multiple = MultipleScattering::occluded;
  const auto with = [&](const std::string& name, std::uint32_t cascades, std::uint32_t first, std::uint32_t resolution,
                        double floor_db) {
    show(seen(name, [=](BoxScene& s) {
      s.extent = {96, 54};
      s.cascades = cascades;
      s.first_marched = first;
      s.shadow_resolution = resolution;
    }));
    expect_alike(name, params, floor_db);
  };
  with("none", 0, 0, 512, 42.0);
  for (const std::uint32_t n : {1U, 2U, 5U, 8U}) with(std::to_string(n) + " cascades", n, 0, 256, 40.0);
  with("8 cascades from the third on", 8, 3, 256, 40.0);
  with("8 cascades, the last alone", 8, 7, 256, 40.0);
  with("2048 texels, four times what trees have room for", 2, 0, 2048, 40.0);
  with("64 texels", 3, 0, 64, 41.0);
  with("333 texels", 3, 0, 333, 40.0);
}

TEST_F(Epipolar, SceneDepthMayBeStandardAndShadowDepthReversed) {
  BoxScene scene;
  scene.extent = {96, 54};
  scene.far_m = 30000.0;
  Params params = small_params();
  params.scattering.single = SingleScattering::integration;
  show(scene);
  const Picture usual = draw(params, "reversed depth, standard shadows");
  scene.convention = DepthConvention::standard;
  scene.shadow_depth_reversed = true;
  EffectDesc description = desc();
  description.sky_depth = 1.0F;
  description.shadow_depth_reversed = true;
  make(own_effect_, description);
  show(scene);
  const std::string name = "standard depth, reversed shadows";
  expect_alike(name, params, 44.0);
  const Picture swapped = draw(params, name);
  params.epipolar.min_max_tree = false;
  // Without the tree, the lengths of lit sections are added in other groups. Rounding may then change the square root
  // of a mean source function by one step of half precision, and so the radiance of a pixel by twice that. A wrong
  // decision of the tree would change more, and so would a difference in many samples.
  const Likeness without_tree = compare(draw(params, name), swapped, scene.extent);
  EXPECT_LE(without_tree.worst_relative_error, 2.0 / 1024.0);
  EXPECT_LE(without_tree.mean_relative_error, 1e-5);
  const Likeness likeness = compare(swapped, usual, scene.extent);
  RecordProperty("dB: the one and the other", hundredths(likeness.psnr_db));
  EXPECT_GE(likeness.psnr_db, 60.0);
}

TEST_F(Epipolar, FewestAndMostSlicesAndSamples) {
  BoxScene scene;
  scene.extent = {96, 54};
  show(scene);
  Params params = small_params();
  const auto with = [&](std::uint32_t slices, std::uint32_t samples, bool optimised, double floor_db) {
    params.epipolar.slices = slices;
    params.epipolar.samples = samples;
    params.epipolar.optimize_locations = optimised;
    expect_alike(
        std::to_string(slices) + " slices, " + std::to_string(samples) + " samples" + (optimised ? "" : ", all used"),
        params, floor_db);
  };
  // The shafts between the boxes are narrower than the spacing of 32 slices. The default scene at 1280 x 720 has 40 dB
  // with as few slices.
  with(32, 32, true, 36.0);
  with(2048, 32, true, 40.0);
  with(32, 2048, true, 36.0);
  with(2048, 2048, true, 40.0);
  with(128, 2048, false, 41.0);
  with(33, 33, true, 36.0);
}

// Fewer than 256 slices that are four pixels apart have pipelines of their own.
TEST_F(Epipolar, FewSlicesAreAccurateInEveryMode) {
  for (const VkExtent2D extent : {VkExtent2D{160, 90}, VkExtent2D{96, 54}}) {
    const auto with = [&](const std::string& name, const std::function<void(Params&)>& change, double floor_db) {
      Params params = small_params();
      params.epipolar.slices = 40;
      change(params);
      expect_alike(std::to_string(extent.width) + " pixels wide, 40 slices, " + name, params, floor_db);
    };
    BoxScene scene;
    scene.extent = extent;
    show(scene);
    with(
        "integrated", [](Params& p) { p.scattering.single = SingleScattering::integration; }, 37.5);
    with(
        "higher orders alone", [](Params& p) { p.scattering.single = SingleScattering::none; }, 44.0);
    with(
        "no shafts", [](Params& p) { p.scattering.light_shafts = false; }, 46.0);
    with(
        "extinction per pixel", [](Params& p) { p.scattering.extinction = Extinction::per_pixel; }, 37.5);
    with(
        "correct_depth_breaks", [](Params& p) { p.epipolar.correct_depth_breaks = true; }, 37.0);
    scene.name = "below the horizon";
    scene.sun.elevation_deg = -2.0;
    show(scene);
    with(
        "sun below the horizon", [](Params&) {}, 37.0);
    scene = {};
    scene.name = "limb";
    scene.extent = extent;
    scene.altitude_m = 400000.0;
    scene.pitch_deg = -20.0;
    scene.tan_half_height = 0.12;
    scene.buildings = scene.ground = false;
    scene.cascades = 0;
    show(scene);
    with(
        "limb", [](Params&) {}, 44.0);
  }
}

// Temporal anti-aliasing moves the projection by parts of a pixel. Four jittered pictures are those of every second
// pixel and line of a picture of twice the size.
TEST_F(Epipolar, JitteredPicturesAreSamplesOfALargerOne) {
  BoxScene scene;
  scene.name = "jitter";
  const VkExtent2D extent = {80, 46};
  scene.extent = {2 * extent.width, 2 * extent.height};
  show(scene);
  const Picture large = draw(by_brute_force(small_params()), "twice the size");
  scene.extent = extent;
  Picture marched(large.size()), epipolar(large.size());
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t right = i % 2, down = i / 2;
    show(frame_of(scene, {right == 0 ? -0.25 : 0.25, down == 0 ? -0.25 : 0.25}));
    const Picture a = draw(by_brute_force(small_params()), "jittered, brute force");
    const Picture b = draw(small_params(), "jittered");
    for (std::uint32_t y = 0; y < extent.height; ++y) {
      for (std::uint32_t x = 0; x < extent.width; ++x) {
        const std::size_t to = (2 * y + down) * std::size_t{2} * extent.width + 2 * x + right;
        marched[to] = a[y * extent.width + x];
        epipolar[to] = b[y * extent.width + x];
      }
    }
  }
  const VkExtent2D twice = {2 * extent.width, 2 * extent.height};
  EXPECT_GE(compare(marched, large, twice).psnr_db, 60.0);
  EXPECT_GE(compare(epipolar, large, twice).psnr_db, 40.0);
}

}  // namespace
}  // namespace tyndall
