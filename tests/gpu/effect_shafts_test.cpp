// Light shafts, drawn through the public interface. The shadow is known exactly: everything west of a vertical plane
// that contains the direction of the sun. The expected light is an integral over the lit parts of each ray in double
// precision.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "effect_frame.hpp"

namespace tyndall {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
// Marching evaluates the medium once per group of eight texels, and at least integration_steps times. A ray that
// crosses a quarter to a half of a map of 1024 texels has 32 to 64 groups. The error of the midpoint rule is (group /
// scale of the integrand)^2 / 24, which is below 0.2 % if a group is at most a fifth of that scale.
constexpr double kMarchTolerance = 0.002;
constexpr std::uint32_t kResolution = 1024;
// The edge of a shadow is a ramp of one texel, and the medium is evaluated in the middle of the group, wherever the
// edge is. A texel is long for a ray that is nearly parallel to the edge.
constexpr double kEdgeTolerance = 0.005;

enum class Shadow : std::uint32_t { none, everywhere, west };

struct Setting {
  const char* name;
  double altitude_m, pitch_deg;
  double far_m;  // end of the last cascade
  double sun_elevation_deg;
  std::uint32_t resolution = kResolution;
};
// The shafts are tens of kilometres long, and hundreds in the view from space. That view has a higher resolution,
// because a texel would otherwise be longer than the atmosphere is high.
constexpr Setting kSettings[] = {{"ground", 5.0, 15.0, 40.0e3, 20.0},
                                 {"air", 6000.0, -3.0, 60.0e3, 4.0},
                                 {"below the horizon", 9000.0, 4.0, 60.0e3, -2.0},
                                 {"zenith", 3000.0, 0.0, 40.0e3, 90.0},
                                 {"space", 400000.0, -30.0, 900.0e3, 30.0, 4 * kResolution}};

// Adds cascades of equal depth up to `far_m`. The sun is in the north or south, so the plane x = 0 contains it.
void add_shadows(TestFrame& frame, const Setting& setting, Shadow shadow, std::uint32_t count) {
  const double e = setting.sun_elevation_deg * kRad;
  frame.to_sun = {0.0, std::sin(e), -std::cos(e)};
  const glm::dvec3 across(0.0, std::cos(e), std::sin(e));
  frame.cascades.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    Cascade cascade;
    cascade.near_m = i <= frame.first_marched ? 0.0F : static_cast<float>(setting.far_m * i / count);
    cascade.far_m = static_cast<float>(setting.far_m * (i + 1) / count);
    // A square around the view. The distance of its corners at tan_half 0.6 is 1.3 times their depth. The plane x = 0
    // is between two texels.
    const double half = cascade.far_m;
    const double texel = 2.0 * half / frame.shadow_resolution;
    glm::dvec3 middle = frame.view.position + frame.view.forward * (0.55 * cascade.far_m);
    middle.x = std::round(middle.x / texel) * texel;
    const glm::dvec3 rows[3] = {glm::dvec3(0.5 / half, 0.0, 0.0), across * (0.5 / half), frame.to_sun * (-0.5 / half)};
    for (int r = 0; r < 3; ++r) {
      const double offset = 0.5 - glm::dot(rows[r], middle);
      const bool flipped = r == 2 && frame.shadow_depth_reversed;
      for (int c = 0; c < 3; ++c) {
        cascade.shadow_from_world.m[4 * c + r] = static_cast<float>(flipped ? -rows[r][c] : rows[r][c]);
      }
      cascade.shadow_from_world.m[12 + r] = static_cast<float>(flipped ? 1.0 - offset : offset);
    }
    frame.cascades.push_back(cascade);
  }
  const float nearest = frame.shadow_depth_reversed ? 1.0F : 0.0F;
  frame.shadow_depth = [=, first = frame.first_marched, cascades = frame.cascades](std::uint32_t c, double u,
                                                                                   double /*v*/) {
    // Cascades that are not marched are all in shadow, so that reading them would show in the picture.
    const double edge = cascades[c].shadow_from_world.m[12];  // u where x is 0
    const bool dark = c < first || shadow == Shadow::everywhere || (shadow == Shadow::west && u < edge);
    return dark ? nearest : 1.0F - nearest;
  };
}

TestFrame frame_for(const Setting& setting, double yaw_deg) {
  TestFrame frame;
  frame.shadow_resolution = setting.resolution;
  frame.view = TestView::at(setting.altitude_m, yaw_deg * kRad, setting.pitch_deg * kRad, 0.6);
  // The camera is beside the plane, on its lit side, so that rays cross the plane at all distances.
  frame.view.position.x = 0.05 * setting.far_m;
  return frame;
}

struct Truth {
  glm::dvec3 shadowed;    // expected light of the ray
  glm::dvec3 unshadowed;  // its light without shadows
};

Truth truth_of(const Params& params, const TestFrame& frame, const Setting& setting, Shadow shadow, std::uint32_t x,
               std::uint32_t y) {
  const RayAngles ray = frame.ray(x, y, params.planet.radius_m);
  const auto air = segment_below_top(params, ray);
  if (!air) return {};
  double end = air->end;
  const double seen = frame.distance_m ? frame.distance_m(x, y) : 0.0;
  if (seen > 0.0) end = std::min(end, seen);
  const glm::dvec3 direction = frame.view.ray(x, y, frame.extent);
  const double mapped = std::clamp(setting.far_m / glm::dot(direction, frame.view.forward), air->start, end);
  const double crossing = -frame.view.position.x / direction.x;  // distance to the edge of the shadow
  double dark_from = air->start;
  double dark_to = mapped;
  if (shadow == Shadow::none) dark_to = dark_from;
  if (shadow == Shadow::west) {
    const bool begins_lit = frame.view.position.x > 0.0;
    const bool crosses = crossing > 0.0;
    if (begins_lit) dark_from = crosses ? std::clamp(crossing, air->start, mapped) : mapped;
    if (!begins_lit && crosses) dark_to = std::clamp(crossing, air->start, mapped);
  }
  return {true_inscattering(params, ray, air->start, dark_from) + true_inscattering(params, ray, dark_to, end),
          true_inscattering(params, ray, air->start, end)};
}

class EffectShafts : public GpuTest {
 protected:
  void TearDown() override {
    effects_.clear();
    GpuTest::TearDown();
  }

  std::vector<glm::dvec3> draw(const Params& params, const TestFrame& frame) {
    Result<std::vector<glm::dvec3>> image = effects_.render(host(), params, frame);
    EXPECT_OK(image);
    const std::size_t pixels = static_cast<std::size_t>(frame.extent.width) * frame.extent.height;
    return image.ok() ? std::move(image).value() : std::vector<glm::dvec3>(pixels);
  }

  // The largest and the mean error of a pixel, relative to the ray without shadows, and the smallest lit fraction.
  struct Errors {
    double worst = 0.0, mean = 0.0, min_lit = 1.0;
  };
  Errors errors_of(const Params& params, const TestFrame& frame, const Setting& setting, Shadow shadow) {
    const std::vector<glm::dvec3> image = draw(params, frame);
    Errors out;
    int count = 0;
    for (std::uint32_t y = 0; y < frame.extent.height; ++y) {
      for (std::uint32_t x = 0; x < frame.extent.width; ++x) {
        const Truth truth = truth_of(params, frame, setting, shadow, x, y);
        const double whole = std::max({truth.unshadowed.x, truth.unshadowed.y, truth.unshadowed.z});
        const glm::dvec3 off = glm::abs(image[y * frame.extent.width + x] - truth.shadowed);
        const double error = std::max({off.x, off.y, off.z});
        if (whole == 0.0) {
          EXPECT_EQ(error, 0.0);
          continue;
        }
        out.worst = std::max(out.worst, error / whole);
        out.mean += (error / whole - out.mean) / ++count;
        out.min_lit = std::min(out.min_lit, truth.shadowed.y / truth.unshadowed.y);
      }
    }
    return out;
  }

 private:
  EffectCache effects_;
};

TEST_F(EffectShafts, AllLitEqualsNoShadows) {
  const Params params = precise_params();
  for (const Setting& setting : kSettings) {
    TestFrame frame = frame_for(setting, 10.0);
    add_shadows(frame, setting, Shadow::none, 1);
    const Errors j = errors_of(params, frame, setting, Shadow::none);
    EXPECT_LE(j.worst, kMarchTolerance) << setting.name;
  }
}

TEST_F(EffectShafts, AllInShadowIsBlackUpToTheEndOfTheLastCascade) {
  Params params = precise_params();
  for (const Setting& setting : kSettings) {
    TestFrame frame = frame_for(setting, 10.0);
    // The left half sees geometry within the map, the right half the sky.
    frame.distance_m = [&](std::uint32_t x, std::uint32_t) { return x < 8 ? 0.9 * setting.far_m : 0.0; };
    add_shadows(frame, setting, Shadow::everywhere, 1);
    const std::vector<glm::dvec3> image = draw(params, frame);
    for (std::uint32_t y = 0; y < frame.extent.height; ++y) {
      for (std::uint32_t x = 0; x < 8; ++x) {
        ASSERT_EQ(image[y * frame.extent.width + x], glm::dvec3(0.0)) << setting.name << " " << x << " " << y;
      }
    }
    // Beyond the last cascade everything is lit, with the same sum as without a shadow.
    const Errors j = errors_of(params, frame, setting, Shadow::everywhere);
    EXPECT_LE(j.worst, kMarchTolerance) << setting.name;
    EXPECT_LT(j.min_lit, 0.9) << setting.name;
  }
}

TEST_F(EffectShafts, TheEdgeOfAShadowIsAtItsPosition) {
  const Params params = precise_params();
  for (const Setting& setting : kSettings) {
    // Views from the light into the shadow, along the edge, and from the shadow into the light.
    for (const auto& [yaw_deg, side] : {std::pair(-35.0, 1.0), {80.0, 1.0}, {200.0, -1.0}}) {
      TestFrame frame = frame_for(setting, yaw_deg);
      frame.view.position.x = side * 0.05 * setting.far_m;
      add_shadows(frame, setting, Shadow::west, 1);
      const Errors j = errors_of(params, frame, setting, Shadow::west);
      EXPECT_LE(j.worst, kEdgeTolerance) << setting.name << " yaw " << yaw_deg << " side " << side;
    }
  }
}

TEST_F(EffectShafts, AnyNumberOfCascadesGivesTheSameShafts) {
  const Params params = precise_params();
  const Setting& setting = kSettings[1];
  for (const std::uint32_t count : {0U, 1U, 2U, 5U, kMaxCascades}) {
    for (const std::uint32_t first : std::set<std::uint32_t>{0U, count / 2}) {
      TestFrame frame = frame_for(setting, -35.0);
      frame.first_marched = first;
      add_shadows(frame, setting, Shadow::west, count);
      // Without cascades there is no shadow.
      const Shadow truth = count == 0 ? Shadow::none : Shadow::west;
      EXPECT_LE(errors_of(params, frame, setting, truth).worst, kEdgeTolerance) << count << " from " << first;
    }
  }
}

TEST_F(EffectShafts, ReversedShadowDepthIsTheSamePicture) {
  const Params params = precise_params();
  const Setting& setting = kSettings[1];
  TestFrame frame = frame_for(setting, -35.0);
  // Depths are between 0 and 1, so that the direction of the comparison matters. The caster is a roof at a right angle
  // to the sun's rays, 2 km from the camera towards the sun, over the western half.
  const auto roofed = [&](bool reversed) {
    frame.shadow_depth_reversed = reversed;
    add_shadows(frame, setting, Shadow::west, 2);
    const glm::dvec4 roof_point(frame.view.position + frame.to_sun * 2000.0, 1.0);
    frame.shadow_depth = [=, cascades = frame.cascades](std::uint32_t c, double u, double /*v*/) {
      const float* m = cascades[c].shadow_from_world.m;
      if (u >= m[12]) return reversed ? 0.0F : 1.0F;
      return static_cast<float>(glm::dot(roof_point, glm::dvec4(m[2], m[6], m[10], m[14])));
    };
    return draw(params, frame);
  };
  const std::vector<glm::dvec3> standard = roofed(false);
  const std::vector<glm::dvec3> reversed = roofed(true);
  TestFrame lit = frame;
  lit.cascades.clear();
  const std::vector<glm::dvec3> open = draw(params, lit);
  double shadowed = 0.0;
  for (std::size_t i = 0; i < standard.size(); ++i) {
    // Because of rounding, one in about 250 reads of the map may be on the other side of the roof.
    EXPECT_LE(glm::length(standard[i] - reversed[i]), 0.005 * glm::length(open[i])) << i;
    shadowed = std::max(shadowed, 1.0 - standard[i].y / open[i].y);
  }
  EXPECT_GT(shadowed, 0.1);
}

TEST_F(EffectShafts, WithoutLightShaftsTheMapsAreNotRead) {
  Params params = precise_params();
  TestFrame frame = frame_for(kSettings[0], 10.0);
  const std::vector<glm::dvec3> open = draw(params, frame);
  add_shadows(frame, kSettings[0], Shadow::everywhere, 3);
  frame.to_sun = TestFrame().to_sun;
  params.scattering.light_shafts = false;
  EXPECT_EQ(draw(params, frame), open);
  params.scattering.light_shafts = true;
  EXPECT_NE(draw(params, frame), open);
}

}  // namespace
}  // namespace tyndall
