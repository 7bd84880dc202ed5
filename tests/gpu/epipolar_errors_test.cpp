// Epipolar sampling in difficult scenes: an occluder in front of the sun, twilight, more depth discontinuities than can
// be corrected, and skies in which seams would be visible. The reference is brute force with the same frame and the
// same shadow maps.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "shared_effect.hpp"

namespace tyndall {
namespace {

using EpipolarErrors = SharedEffect;

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

// A pillar that hides the sun, in haze under a low sun.
struct Pillar {
  const char* name;
  double distance_m, half_width_m;
  double sun_from_middle;  // distance of the sun from the middle of the pillar, in half widths of it
  double sun_elevation_deg, altitude_m, far_m;
  float aerosol_density;
  double bound;  // maximum relative error of a pixel of its face
};

BoxScene scene_of(const Pillar& pillar) {
  BoxScene scene;
  scene.name = pillar.name;
  scene.extent = {640, 240};
  scene.tan_half_height = 0.25;
  scene.altitude_m = pillar.altitude_m;
  scene.pitch_deg = 8.0;
  scene.sun.azimuth_deg = std::atan(pillar.sun_from_middle * pillar.half_width_m / pillar.distance_m) * 57.29578;
  scene.sun.elevation_deg = pillar.sun_elevation_deg;
  scene.far_m = pillar.far_m;
  scene.shadow_resolution = 512;
  scene.own_buildings = {{{-pillar.half_width_m, 0, -pillar.distance_m - pillar.half_width_m},
                          {pillar.half_width_m, pillar.distance_m + 50.0, -pillar.distance_m}}};
  return scene;
}

// The sides of the pillar are not compared, because the texels of shadow maps are wider than a pixel there, and the
// techniques read them at different positions.
TEST_F(EpipolarErrors, AnOccluderOfTheSunHasNoBrightPixels) {
  const Pillar pillars[] = {
      {"sun in the middle", 500.0, 40.0, 0.0, 9.0, 20.0, 2000.0, 1.0F, 0.05},
      {"narrow", 3000.0, 60.0, 0.3, 3.0, 100.0, 20000.0, 5.0F, 0.05},
      {"wide", 3000.0, 240.0, 0.9, 3.0, 100.0, 20000.0, 5.0F, 0.05},
  };
  constexpr std::uint32_t kInside = 3;  // pixels from the sides
  for (const Pillar& pillar : pillars) {
    const BoxScene scene = scene_of(pillar);
    show(scene);
    for (const bool tree : {true, false}) {
      Params params = small_params();
      params.epipolar.slices = 512;
      params.epipolar.samples = 256;
      params.atmosphere.aerosol_density = pillar.aerosol_density;
      params.epipolar.min_max_tree = tree;
      const Picture reference = draw(by_brute_force(params), scene.name);
      const Picture picture = draw(params, scene.name);
      const auto on_face = [&](std::uint32_t x, std::uint32_t y) {
        const double d = frame().distance_m(x, y);
        return d > 0.0 && d < 1.2 * pillar.distance_m;
      };
      double worst = 0.0;
      std::size_t face = 0;
      std::string where;
      for (std::uint32_t y = 0; y < 180; ++y) {
        for (std::uint32_t x = kInside; x + kInside < scene.extent.width; ++x) {
          if (!on_face(x - kInside, y) || !on_face(x + kInside, y)) continue;
          ++face;
          const std::size_t i = std::size_t{y} * scene.extent.width + x;
          const double off = largest(glm::abs(picture[i] - reference[i])) / largest(reference[i]);
          if (off <= worst) continue;
          worst = off;
          where = std::to_string(x) + ", " + std::to_string(y);
        }
      }
      EXPECT_GT(face, 1000U);
      EXPECT_LE(worst, pillar.bound) << pillar.name << (tree ? "" : ", no tree") << ", at " << where;
    }
  }
}

// In twilight, the planet's shadow curves the in-scattering, but not unshadowed in-scattering. Compares the sky above
// the horizon at its own exposure.
TEST_F(EpipolarErrors, TwilightSkyIsLikeBruteForce) {
  BoxScene scene;
  scene.name = "twilight";
  scene.extent = {480, 256};
  scene.altitude_m = 8000.0;
  scene.pitch_deg = 8.0;
  scene.sun.azimuth_deg = 0.0;
  scene.sun.elevation_deg = -7.0;
  scene.buildings = false;
  scene.cascades = 0;
  show(scene);
  Params params = small_params();
  params.epipolar.slices = 512;
  params.epipolar.samples = 256;
  Picture reference = draw(by_brute_force(params), "brute force");
  Picture picture = draw(params, scene.name);
  const VkExtent2D sky = {scene.extent.width, 180};
  reference.resize(std::size_t{sky.width} * sky.height);
  picture.resize(reference.size());
  const double psnr_db = compare(picture, reference, sky).psnr_db;
  RecordProperty("dB", hundredths(psnr_db));
  EXPECT_GE(psnr_db, 65.0);  // 63.1 with the initial samples of daytime
}

// Between the horizon of sea level and that of lower land, 0.7 degrees below it, the sky of the tables is as smooth as
// above: from row to row it changes by a few per cent. If rays ended at sea level, there would be a dark line.
// With the sun at a right angle to the view, the slices are nearly parallel to the upper and the lower border. The last
// one may cross only a corner of the picture, but all pixels of the border are between it and the next one.
TEST_F(EpipolarErrors, ThePictureHasNoLineAtItsBorder) {
  BoxScene scene;
  scene.name = "the sun beside the view";
  scene.extent = {240, 136};
  scene.altitude_m = 8000.0;
  scene.pitch_deg = 8.0;
  scene.buildings = false;
  scene.cascades = 0;
  const std::uint32_t width = scene.extent.width, height = scene.extent.height;
  double worst = 0.0;
  std::string where;
  for (const double elevation_deg : {-3.0, 2.0, 12.0}) {
    for (const double azimuth_deg : {87.0, 91.0, 95.0, 97.0}) {
      scene.sun.elevation_deg = elevation_deg;
      scene.sun.azimuth_deg = azimuth_deg;
      show(scene);
      const Picture reference = draw(by_brute_force(small_params()), "brute force");
      const Picture picture = draw(small_params(), scene.name);
      for (const std::uint32_t y : {0U, 1U, height - 2, height - 1}) {
        for (std::uint32_t x = 0; x < width; ++x) {
          const std::size_t i = std::size_t{y} * width + x;
          const double off = largest(glm::abs(picture[i] - reference[i])) / largest(reference[i]);
          if (off <= worst) continue;
          worst = off;
          where = "sun at " + std::to_string(elevation_deg) + " deg, azimuth " + std::to_string(azimuth_deg) +
                  " deg, pixel " + std::to_string(x) + ", " + std::to_string(y);
        }
      }
    }
  }
  EXPECT_LE(worst, 0.03) << where;  // 0.18 without the longer slices
}

TEST_F(EpipolarErrors, TheSkyHasNoLineAboveLowerLand) {
  for (const double altitude : {2.0, -130.0}) {
    BoxScene scene;
    scene.name = "above the Dead Sea, " + std::to_string(altitude) + " m";
    scene.extent = {16, 64};
    scene.altitude_m = altitude;
    scene.ground_altitude_m = -430.0;
    scene.buildings = scene.ground = false;
    scene.cascades = 0;
    scene.tan_half_height = 0.02;
    scene.pitch_deg = 0.6;
    show(scene);
    for (const Params& params : {small_params(), by_brute_force(small_params())}) {
      const Picture picture = draw(params, scene.name);
      for (std::size_t y = 0; y + 1 < scene.extent.height; ++y) {
        const std::size_t at = y * scene.extent.width + scene.extent.width / 2;
        const glm::dvec3 ratio = picture[at + scene.extent.width] / picture[at];
        EXPECT_LT(std::max({ratio.x, ratio.y, ratio.z}), 1.1) << scene.name << ", row " << y;
        EXPECT_GT(std::min({ratio.x, ratio.y, ratio.z}), 0.9) << scene.name << ", row " << y;
      }
    }
  }
}

// With random depths, most pixels fit no sample, and there are more of them than the list can hold.
TEST_F(EpipolarErrors, TooManyDepthDiscontinuitiesAreNotCorrected) {
  TestFrame scattered = frame_of({});
  const std::uint32_t width = scattered.extent.width;
  scattered.distance_m = [width](std::uint32_t x, std::uint32_t y) {
    const std::uint32_t mixed = (y * width + x) * 2654435761U;
    return 500.0 * std::pow(1.5, mixed >> 28U);
  };
  EffectDesc description = desc();
  description.max_extent = scattered.extent;
  make(own_effect_, description);
  show(scattered);
  const std::uint64_t pixels = std::uint64_t{scattered.extent.width} * scattered.extent.height;
  Params params = small_params();
  const Picture reference = draw(by_brute_force(params), "brute force");
  const Picture picture = draw(params, "more than there is room for");
  EXPECT_EQ(counters().pixels_corrected, 0U);
  EXPECT_EQ(draw(params, "again"), picture);
  params.epipolar.correct_depth_breaks = true;
  const Picture corrected = draw(params, "room for all");
  EXPECT_GT(counters().pixels_corrected, pixels / 8);
  EXPECT_LE(counters().pixels_corrected, pixels);
  EXPECT_GT(compare(corrected, reference, scattered.extent).psnr_db,
            compare(picture, reference, scattered.extent).psnr_db + 3.0);
}

// Slices leave the ground at different positions of the skyline. None of them may cause a visible seam in the sky.
TEST_F(EpipolarErrors, FewSlicesCauseNoSeamInTheSky) {
  struct Case {
    const char* name;
    VkExtent2D extent;
    std::uint32_t slices;
    double sun_x, sun_y;
    std::size_t max_steps;
  };
  constexpr double kStep = 0.05;  // relative change from pixel to pixel that brute force does not have
  const Case cases[] = {{"32 slices, sun in view", {160, 90}, 32, 0.8, -0.8, 6},
                        {"32 slices, sun beside the view", {160, 90}, 32, 1.6, -0.9, 6},
                        {"300 slices, sun in view", {1800, 250}, 300, 0.8, -0.8, 6}};
  for (const Case& c : cases) {
    BoxScene scene = sun_at(c.name, c.sun_x, c.sun_y, 6.0);
    scene.extent = c.extent;
    show(scene);
    Params params = small_params();
    params.epipolar.slices = c.slices;
    params.epipolar.samples = 256;
    const Picture reference = draw(by_brute_force(params), scene.name);
    const Picture picture = draw(params, scene.name);
    const auto sky = [&](std::uint32_t x, std::uint32_t y) { return frame().distance_m(x, y) == 0.0; };
    std::size_t seen_pixels = 0;
    std::size_t steps = 0;
    for (std::uint32_t y = 0; y + 1 < c.extent.height; ++y) {
      for (std::uint32_t x = 0; x + 1 < c.extent.width; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * c.extent.width + x;
        if (!sky(x, y) || !sky(x + 1, y)) continue;
        ++seen_pixels;
        const glm::dvec3 off = (picture[i + 1] - picture[i] - reference[i + 1] + reference[i]) / reference[i];
        steps += std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) > kStep ? 1 : 0;
      }
    }
    RecordProperty(std::string("steps: ") + c.name, std::to_string(steps) + " of " + std::to_string(seen_pixels));
    EXPECT_GT(seen_pixels, reference.size() / 10) << c.name;
    EXPECT_LE(steps, c.max_steps) << c.name;
  }
}

// Smooth in-scattering is also smooth across slices. A seam would increase the second differences above those of brute
// force.
TEST_F(EpipolarErrors, SmoothLightHasNoSeams) {
  for (const bool inside : {true, false}) {
    BoxScene scene = inside ? sun_at("sun in view", 0.31, -0.23, 25.0) : sun_at("sun beside the view", 1.8, -1.5, 25.0);
    scene.buildings = scene.ground = false;
    scene.cascades = 0;
    scene.tan_half_height = 0.06;  // the sky changes almost linearly from pixel to pixel
    show(scene);
    Params params = small_params();
    const Picture reference = draw(by_brute_force(params), scene.name);
    const Picture picture = draw(params, scene.name);
    double worst = 0.0;
    const std::uint32_t width = scene.extent.width;
    for (std::uint32_t y = 1; y + 1 < scene.extent.height; ++y) {
      for (std::uint32_t x = 1; x + 1 < width; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * width + x;
        for (const std::size_t step : {std::size_t{1}, std::size_t{width}}) {
          const auto second = [&](const Picture& p) { return p[i - step] - 2.0 * p[i] + p[i + step]; };
          const glm::dvec3 off = glm::abs(second(picture) - second(reference)) / reference[i];
          worst = std::max({worst, off.x, off.y, off.z});
        }
      }
    }
    RecordProperty("seam: " + scene.name, std::to_string(worst));
    EXPECT_LE(worst, 0.03) << scene.name;
  }
}

}  // namespace
}  // namespace tyndall
