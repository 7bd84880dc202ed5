// The atmosphere without shadows, drawn through the public interface: sky, aerial perspective, and the parameters that
// select what is drawn, compared with the CPU model in double precision.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "effect_frame.hpp"

namespace tyndall {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
// With these steps, integration has an error of 0.1 % (shaders/lib/single_scattering.glsl). Near the horizon, where
// density changes steeply, single precision of altitudes and directions adds as much.
constexpr double kTolerance = 0.002;

glm::dvec3 sun_at(double elevation_deg, double azimuth_deg = 30.0) {
  const double e = elevation_deg * kRad;
  const double a = azimuth_deg * kRad;
  return {std::cos(e) * std::sin(a), std::sin(e), -std::cos(e) * std::cos(a)};
}

class EffectAir : public GpuTest {
 protected:
  void TearDown() override {
    effects_.clear();
    GpuTest::TearDown();
  }

  std::vector<glm::dvec3> draw(const Params& params, const TestFrame& frame,
                               OutputFormat format = OutputFormat::rgba32f) {
    Result<std::vector<glm::dvec3>> image = effects_.render(host(), params, frame, format);
    EXPECT_OK(image);
    const std::size_t pixels = static_cast<std::size_t>(frame.extent.width) * frame.extent.height;
    return image.ok() ? std::move(image).value() : std::vector<glm::dvec3>(pixels);
  }

 private:
  EffectCache effects_;
};

struct Place {
  const char* name;
  double altitude_m, pitch_deg, tan_half;
};
// Below sea level, on the ground, in the atmosphere, and in space with the planet filling a part of the picture.
constexpr Place kPlaces[] = {{"below sea level", -430.0, 10.0, 1.0},
                             {"ground", 2.0, 20.0, 1.0},
                             {"air", 9000.0, -5.0, 1.2},
                             {"space", 400000.0, -20.0, 0.7}};

TEST_F(EffectAir, TheSkyIsTheIntegralFromGroundAtmosphereAndSpace) {
  for (const Place& place : kPlaces) {
    for (const double elevation : {60.0, 3.0, -8.0}) {
      TestFrame frame;
      frame.view = TestView::at(place.altitude_m, 0.3, place.pitch_deg * kRad, place.tan_half);
      frame.to_sun = sun_at(elevation);
      frame.background = {0.25F, 0.5F, 1.0F};
      const Params params = precise_params();
      const std::vector<glm::dvec3> image = draw(params, frame);
      double brightest = 0.0;
      for (std::uint32_t y = 0; y < frame.extent.height; ++y) {
        for (std::uint32_t x = 0; x < frame.extent.width; ++x) {
          const RayAngles ray = frame.ray(x, y, params.planet.radius_m);
          const auto air = segment_below_top(params, ray);
          glm::dvec3 truth(0.25, 0.5, 1.0);
          if (air) {
            truth *= true_transmittance(params, ray, air->end);
            const glm::dvec3 scattered = true_inscattering(params, ray, air->start, air->end);
            brightest = std::max(brightest, scattered.z);
            truth += scattered;
          }
          ASSERT_LE(relative_error(image[y * frame.extent.width + x], truth), kTolerance)
              << place.name << ", sun at " << elevation << ", pixel " << x << " " << y;
        }
      }
      // The picture is not just black.
      EXPECT_GT(brightest, elevation < 0.0 ? 1e-6 : 1e-2) << place.name << ", sun at " << elevation;
    }
  }
}

// From the shore of the Dead Sea, the sky between the horizon of sea level and that of the land, 0.7 degrees lower, is
// the integral to the top of the atmosphere. Below the lower horizon, rays end on a sphere at the altitude of the land.
TEST_F(EffectAir, TheSkyReachesTheHorizonOfLowerLand) {
  constexpr double kLand = -430.0;
  for (const double altitude : {2.0, -20.0, -130.0}) {
    for (const Technique technique : {Technique::brute_force, Technique::epipolar, Technique::froxels}) {
      TestFrame frame;
      frame.extent = {8, 32};
      frame.view = TestView::at(altitude, 0.3, -0.6 * kRad, 0.02);
      frame.to_sun = sun_at(25.0);
      frame.lowest_ground_m = kLand;
      Params params = precise_params();
      params.scattering.technique = technique;
      const double radius = params.planet.radius_m;
      const std::vector<glm::dvec3> image = draw(params, frame);
      int between = 0;
      int below = 0;
      for (std::uint32_t y = 0; y < frame.extent.height; ++y) {
        for (std::uint32_t x = 0; x < frame.extent.width; ++x) {
          const RayAngles ray = frame.ray(x, y, radius);
          const auto crossing = [&](double at_m, double sign) {
            const double q = (radius + altitude) * ray.cos_view;
            const double squared = q * q + (at_m - altitude) * (2.0 * radius + at_m + altitude);
            return squared < 0.0 ? -1.0 : -q + sign * std::sqrt(squared);
          };
          double end = crossing(kLand, -1.0);
          if (end < 0.0) {
            between += segment_below_top(params, ray)->on_ground ? 1 : 0;
            end = crossing(params.atmosphere.height_m, 1.0);
          } else {
            ++below;
          }
          // Epipolar sampling interpolates next to the horizon, where this picture has one pixel for 300 m of altitude.
          const double tolerance = technique == Technique::brute_force ? kTolerance : 0.05;
          EXPECT_LE(relative_error(image[y * frame.extent.width + x], true_inscattering(params, ray, 0.0, end)),
                    tolerance)
              << altitude << " " << static_cast<int>(technique) << " pixel " << x << " " << y;
        }
      }
      EXPECT_GT(between, altitude < -100.0 ? 10 : 40);
      EXPECT_GT(below, 20);
    }
  }
}

// Along a ray of an eye below sea level, there is a point beyond which the sun has set. Tables would blur this edge,
// with errors of up to 15 %, so order 1 is integrated for such rays, and below the lowest altitude of the tables.
TEST_F(EffectAir, BelowSeaLevelTheSunSetsSharplyWithTables) {
  const double cases[][2] = {{-320.0, 0.18}, {-64.0, 0.03}, {-264.0, -0.2}, {-2000.0, 20.0}};  // altitude, elevation
  for (const auto& [altitude, elevation] : cases) {
    TestFrame frame;
    frame.view = TestView::at(altitude, 2.5, -8.0 * kRad, 0.3);
    frame.to_sun = sun_at(elevation);
    Params params = precise_params();
    params.scattering.single = SingleScattering::table;
    const std::vector<glm::dvec3> image = draw(params, frame);
    for (std::uint32_t y = 0; y < frame.extent.height; ++y) {
      for (std::uint32_t x = 0; x < frame.extent.width; ++x) {
        const RayAngles ray = frame.ray(x, y, params.planet.radius_m);
        const auto air = segment_below_top(params, ray);
        EXPECT_LE(relative_error(image[y * frame.extent.width + x], true_inscattering(params, ray, 0.0, air->end)),
                  kTolerance)
            << altitude << " pixel " << x << " " << y;
      }
    }
  }
}

TEST_F(EffectAir, InScatteringAloneAndOverFiniteSegments) {
  for (const DepthConvention convention : {DepthConvention::reversed_infinite, DepthConvention::standard}) {
    for (const Place& place : kPlaces) {
      TestFrame frame;
      frame.convention = convention;
      frame.view = TestView::at(place.altitude_m, -0.5, place.pitch_deg * kRad, place.tan_half);
      frame.to_sun = sun_at(15.0);
      // Distances range from a metre to beyond the atmosphere, and every eighth pixel shows the sky. With standard
      // depth, which cannot resolve large distances, they are below 5 km, where its error is 1e-3.
      const double longest = convention == DepthConvention::standard ? 5000.0 : 2.0e6;
      frame.distance_m = [&](std::uint32_t x, std::uint32_t y) {
        return (x + y) % 8 == 7 ? 0.0 : 1.5 * std::pow(longest / 1.5, (x + 0.37 * y) / 19.0);
      };
      Params params = precise_params();
      params.scattering.only = true;
      const std::vector<glm::dvec3> scattered = draw(params, frame);
      params.scattering.only = false;
      frame.background = Vec3(8.0F);
      const std::vector<glm::dvec3> seen = draw(params, frame);
      for (std::uint32_t y = 0; y < frame.extent.height; ++y) {
        for (std::uint32_t x = 0; x < frame.extent.width; ++x) {
          const RayAngles ray = frame.ray(x, y, params.planet.radius_m);
          const double distance = frame.distance_m(x, y);
          const auto air = segment_below_top(params, ray);
          glm::dvec3 inscattered(0.0);
          glm::dvec3 through(1.0);
          if (air) {
            if (distance > air->end + 2000.0 && air->on_ground) continue;  // too deep for any light to pass
            // The drawn surface may be below the ground sphere.
            const double end = distance > 0.0 ? (air->on_ground ? distance : std::min(air->end, distance)) : air->end;
            if (end > air->start) {
              inscattered = true_inscattering(params, ray, air->start, end);
              through = true_transmittance(params, ray, end);
            }
          }
          const std::size_t pixel = y * frame.extent.width + x;
          EXPECT_LE(relative_error(scattered[pixel], inscattered), kTolerance)
              << place.name << " " << distance << " pixel " << x << " " << y;
          const glm::dvec3 transmitted = (seen[pixel] - scattered[pixel]) / 8.0;
          EXPECT_LE(relative_error(transmitted, through), kTolerance) << place.name << " " << distance;
        }
      }
    }
  }
}

TEST_F(EffectAir, SwitchesAndScaleDoWhatTheySay) {
  TestFrame frame;
  frame.view = TestView::at(1000.0, 0.0, 0.0, 1.0);
  frame.to_sun = sun_at(20.0);
  frame.background = {0.1F, 0.2F, 0.3F};
  frame.distance_m = [](std::uint32_t x, std::uint32_t) { return x < 8 ? 3000.0 : 0.0; };
  Params params = precise_params();
  const std::vector<glm::dvec3> whole = draw(params, frame);
  params.scattering.only = true;
  const std::vector<glm::dvec3> only = draw(params, frame);
  params.scattering.scale = 0.25F;
  const std::vector<glm::dvec3> quarter = draw(params, frame);
  params.scattering.scale = 1.0F;
  frame.irradiance = {1.0F, 2.0F, 4.0F};
  const std::vector<glm::dvec3> tinted = draw(params, frame);
  params.scattering.enabled = false;
  const std::vector<glm::dvec3> off = draw(params, frame);
  constexpr double kFloat = 1e-6;  // relative error of a few roundings
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_LE(relative_error(off[i], glm::dvec3(0.1F, 0.2F, 0.3F)), 0.0);
    EXPECT_LE(relative_error(quarter[i], 0.25 * only[i]), kFloat);
    EXPECT_LE(relative_error(tinted[i], only[i] * glm::dvec3(1.0, 2.0, 4.0)), kFloat);
    for (int c = 0; c < 3; ++c) {
      EXPECT_GT(whole[i][c], only[i][c]);                             // the background is visible
      EXPECT_LT(whole[i][c], only[i][c] + frame.background.x * 3.0);  // and attenuated
    }
  }
}

TEST_F(EffectAir, HalfPrecisionOutputIsTheSamePicture) {
  TestFrame frame;
  frame.view = TestView::at(1000.0, 0.0, 0.1, 1.0);
  frame.to_sun = sun_at(10.0);
  const Params params = precise_params();
  const std::vector<glm::dvec3> full = draw(params, frame);
  const std::vector<glm::dvec3> half = draw(params, frame, OutputFormat::rgba16f);
  for (std::size_t i = 0; i < full.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      // The mantissa has 11 bits, rounded or truncated.
      EXPECT_NEAR(half[i][c], full[i][c], full[i][c] / 1024.0) << i;
    }
  }
}

TEST_F(EffectAir, HalfPrecisionOutputIsClamped) {
  TestFrame frame;
  frame.view = TestView::at(1000.0, 0.5, 0.2, 0.5);
  frame.to_sun = sun_at(10.0);
  frame.irradiance = Vec3(1e6F);
  Params params = precise_params();
  for (const Technique technique : {Technique::brute_force, Technique::epipolar, Technique::froxels}) {
    params.scattering.technique = technique;
    const std::vector<glm::dvec3> full = draw(params, frame);
    const std::vector<glm::dvec3> half = draw(params, frame, OutputFormat::rgba16f);
    int clamped = 0;
    for (std::size_t i = 0; i < full.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        clamped += full[i][c] > 65504.0 ? 1 : 0;
        EXPECT_NEAR(half[i][c], std::min(full[i][c], 65504.0), full[i][c] / 1024.0) << i;
      }
    }
    EXPECT_GT(clamped, 0);
  }
}

TEST_F(EffectAir, EverySizeIsCoveredToTheLastPixel) {
  const Params params = precise_params();
  for (const VkExtent2D extent : {VkExtent2D{1, 1}, {7, 3}, {1, 65}, {33, 1}, {9, 17}}) {
    TestFrame frame;
    frame.extent = extent;
    frame.view = TestView::at(1000.0, 0.0, 0.2, 0.5);
    frame.to_sun = sun_at(10.0);
    const std::vector<glm::dvec3> image = draw(params, frame);
    for (std::uint32_t y = 0; y < extent.height; ++y) {
      for (std::uint32_t x = 0; x < extent.width; ++x) {
        const RayAngles ray = frame.ray(x, y, params.planet.radius_m);
        const auto air = segment_below_top(params, ray);
        ASSERT_TRUE(air.has_value());
        EXPECT_LE(relative_error(image[y * extent.width + x], true_inscattering(params, ray, 0.0, air->end)),
                  kTolerance)
            << extent.width << "x" << extent.height << " pixel " << x << " " << y;
      }
    }
  }
}

TEST_F(EffectAir, AwayFromTheOriginTheVerticalTurnsWithThePlanet) {
  TestFrame frame;
  frame.to_sun = sun_at(40.0);
  frame.view = TestView::at(0.0, 0.0, 0.0, 1.0);
  // A quarter of the way around the planet, 3 km above it.
  const double radius = 6.36e6;
  frame.view.position = {0.6 * (radius + 3000.0), 0.8 * (radius + 3000.0) - radius, 0.0};
  const Params params = precise_params();
  const std::vector<glm::dvec3> image = draw(params, frame);
  for (std::uint32_t y = 0; y < frame.extent.height; ++y) {
    for (std::uint32_t x = 0; x < frame.extent.width; ++x) {
      const RayAngles ray = frame.ray(x, y, params.planet.radius_m);
      const auto air = segment_below_top(params, ray);
      ASSERT_TRUE(air.has_value());
      EXPECT_LE(relative_error(image[y * frame.extent.width + x], true_inscattering(params, ray, 0.0, air->end)),
                kTolerance);
    }
  }
}

}  // namespace
}  // namespace tyndall
