// The geometry of epipolar sampling that is computed on the CPU: where the sun is in the picture, the sides on which
// slices end, and the memory that the parameters need.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "effect/epipolar_constants.hpp"
#include "effect/resources.hpp"

namespace tyndall {
namespace {

constexpr double kWidth = 160.0;
constexpr double kHeight = 90.0;
constexpr double kTanWidth = 0.8;
constexpr double kTanHeight = 0.45;

// A level camera at the origin of the world that looks north: its view space equals world space. Infinite reversed
// depth.
FrameInputs level_view() {
  FrameInputs inputs;
  inputs.extent = {static_cast<std::uint32_t>(kWidth), static_cast<std::uint32_t>(kHeight)};
  inputs.camera.clip_from_view = Mat4{{}};
  inputs.camera.clip_from_view.m[0] = static_cast<float>(1.0 / kTanWidth);
  inputs.camera.clip_from_view.m[5] = static_cast<float>(-1.0 / kTanHeight);
  inputs.camera.clip_from_view.m[11] = -1.0F;
  inputs.camera.clip_from_view.m[14] = 1.0F;
  return inputs;
}

// Returns the direction seen at a position of the picture [pixels].
Vec3 towards(double x, double y) {
  return {static_cast<float>((2.0 * x / kWidth - 1.0) * kTanWidth),
          static_cast<float>(-(2.0 * y / kHeight - 1.0) * kTanHeight), -1.0F};
}
Vec3 opposite(const Vec3& v) { return {-v.x, -v.y, -v.z}; }

shared::EpipolarConstants with_sun(const Vec3& sun, const Params& params = {}) {
  FrameInputs inputs = level_view();
  inputs.sun.direction_to_sun = sun;
  return epipolar_constants(inputs, {}, params);
}

// Returns the starts of the four sides, in the order of shared/epipolar.h.
std::array<float, 4> side_starts(const shared::EpipolarConstants& c) {
  return {c.left_start, c.bottom_start, c.right_start, c.top_start};
}

// Returns the sides at which slices end, as bits: 1 left, 2 bottom, 4 right, 8 top.
int sides(const shared::EpipolarConstants& c) {
  int out = 0;
  for (int i = 0; i < 4; ++i) out |= side_starts(c)[i] >= 0.0F ? 1 << i : 0;
  return out;
}

// Expects that the sides in use follow each other without gap or overlap, are neighbours in the picture, and make up
// the perimeter.
void expect_chain(const shared::EpipolarConstants& c) {
  const double lengths[4] = {kHeight - 1.0, kWidth - 1.0, kHeight - 1.0, kWidth - 1.0};
  int count = 0;
  int first = -1;
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    if (side_starts(c)[i] < 0.0F) continue;
    ++count;
    sum += lengths[i];
    if (side_starts(c)[i] == 0.0F) {
      EXPECT_EQ(first, -1);
      first = i;
    }
  }
  ASSERT_GE(first, 0);
  EXPECT_NEAR(static_cast<double>(c.perimeter), sum, 1e-3);
  double along = 0.0;
  for (int k = 0; k < count; ++k) {
    const int side = (first + k) % 4;
    EXPECT_NEAR(static_cast<double>(side_starts(c)[side]), along, 1e-3) << side;
    along += lengths[side];
  }
  EXPECT_EQ(c.closed != 0, count == 4);
}

TEST(EpipolarConstants, TheEpipoleIsWhereTheSunIsSeen) {
  for (const auto& [x, y] : {std::pair(80.0, 45.0), {3.25, 71.5}, {159.5, 0.5}, {-400.0, 30.0}, {250.0, 900.0}}) {
    const Vec3 sun = towards(x, y);
    // The length of the direction does not matter. Behind the camera, the epipole is the point opposite to the sun.
    for (const Vec3& s : {sun, Vec3{7.0F * sun.x, 7.0F * sun.y, 7.0F * sun.z}, opposite(sun)}) {
      const shared::EpipolarConstants c = with_sun(s);
      ASSERT_GT(c.sun_w, 0.0F);
      EXPECT_NEAR(static_cast<double>(c.sun_x / c.sun_w), x, 2e-4 * (1.0 + std::abs(x)));
      EXPECT_NEAR(static_cast<double>(c.sun_y / c.sun_w), y, 2e-4 * (1.0 + std::abs(y)));
    }
  }
}

TEST(EpipolarConstants, TheEpipoleFollowsTheCamera) {
  FrameInputs inputs = level_view();
  // The camera looks east, tilted up by 30 degrees. Its position does not matter for infinitely distant points.
  const double s = 0.5;
  const double c = std::cos(std::numbers::pi / 6.0);
  const double columns[4][3] = {{0, 0, 1}, {-s, c, 0}, {-c, -s, 0}, {1e6, 2e3, -3e5}};
  for (int col = 0; col < 4; ++col) {
    for (int row = 0; row < 3; ++row)
      inputs.camera.world_from_view.m[4 * col + row] = static_cast<float>(columns[col][row]);
  }
  inputs.sun.direction_to_sun = {static_cast<float>(c), static_cast<float>(s), 0.0F};
  const shared::EpipolarConstants out = epipolar_constants(inputs, {}, {});
  EXPECT_NEAR(static_cast<double>(out.sun_x / out.sun_w), 80.0, 1e-3);
  EXPECT_NEAR(static_cast<double>(out.sun_y / out.sun_w), 45.0, 1e-3);
}

TEST(EpipolarConstants, ASunAtARightAngleGivesADirection) {
  struct Case {
    Vec3 sun;
    double x, y;  // direction of the epipole in the picture
    int ends;     // sides through which lines from there leave
  };
  const double diagonal = std::atan2(kHeight / kTanHeight, kWidth / kTanWidth);
  for (const Case& at :
       {Case{{1, 0, 0}, 1.0, 0.0, 1}, Case{{-1, 0, 0}, -1.0, 0.0, 4}, Case{{0, 1, 0}, 0.0, -1.0, 2},
        Case{{0, -1, 0}, 0.0, 1.0, 8}, Case{{1, 1, 0}, std::cos(diagonal), -std::sin(diagonal), 1 | 2}}) {
    const shared::EpipolarConstants c = with_sun(at.sun);
    EXPECT_EQ(c.sun_w, 0.0F);
    const double length = std::hypot(static_cast<double>(c.sun_x), static_cast<double>(c.sun_y));
    EXPECT_NEAR(static_cast<double>(c.sun_x) / length, at.x, 1e-6);
    EXPECT_NEAR(static_cast<double>(c.sun_y) / length, at.y, 1e-6);
    EXPECT_EQ(c.sun_in_picture, 0U);
    EXPECT_EQ(sides(c), at.ends);
    expect_chain(c);
    EXPECT_NEAR(std::hypot(static_cast<double>(c.fallback_x), static_cast<double>(c.fallback_y)), 1.0, 1e-6);
  }
}

TEST(EpipolarConstants, SlicesEndWhereLinesFromTheEpipoleLeaveThePicture) {
  struct Case {
    double x, y;
    int ends;
  };
  constexpr int kLeft = 1;
  constexpr int kBottom = 2;
  constexpr int kRight = 4;
  constexpr int kTop = 8;
  for (const Case& at :
       {Case{80.0, 45.0, 15}, Case{1.0, 1.0, 15}, Case{159.0, 89.0, 15}, Case{-20.0, 45.0, kBottom | kRight | kTop},
        Case{200.0, 45.0, kLeft | kBottom | kTop}, Case{80.0, -10.0, kLeft | kBottom | kRight},
        Case{80.0, 100.0, kLeft | kRight | kTop}, Case{-20.0, -20.0, kBottom | kRight},
        Case{200.0, -20.0, kLeft | kBottom}, Case{-20.0, 200.0, kRight | kTop}, Case{200.0, 200.0, kLeft | kTop},
        // Positions between the centres of the outermost pixels and the border of the picture are outside.
        Case{0.25, 45.0, kBottom | kRight | kTop}, Case{80.0, 89.75, kLeft | kRight | kTop}}) {
    for (const bool behind : {false, true}) {
      const Vec3 sun = towards(at.x, at.y);
      const shared::EpipolarConstants c = with_sun(behind ? opposite(sun) : sun);
      EXPECT_EQ(sides(c), at.ends) << at.x << " " << at.y;
      EXPECT_EQ(c.sun_in_picture != 0, at.ends == 15);
      expect_chain(c);
      // The direction away from the epipole leads into the picture.
      EXPECT_GE(static_cast<double>(c.fallback_x) * (80.0 - at.x), 0.0);
      EXPECT_GE(static_cast<double>(c.fallback_y) * (45.0 - at.y), 0.0);
    }
  }
}

TEST(EpipolarConstants, APictureOfOnePixelHasAPositivePerimeter) {
  FrameInputs inputs = level_view();
  inputs.extent = {1, 1};
  for (const Vec3& sun : {Vec3{0, 0, -1}, Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, 1, -1}}) {
    inputs.sun.direction_to_sun = sun;
    const shared::EpipolarConstants c = epipolar_constants(inputs, {}, {});
    EXPECT_GT(c.perimeter, 0.0F);
    for (const float number : {c.sun_x, c.sun_y, c.sun_w, c.fallback_x, c.fallback_y})
      EXPECT_TRUE(std::isfinite(number));
  }
}

TEST(EpipolarConstants, CascadesAreThoseThatAreMarched) {
  FrameInputs inputs = level_view();
  const Cascade cascades[5] = {};
  inputs.cascades = cascades;
  inputs.first_marched_cascade = 2;
  Params params;
  EXPECT_EQ(epipolar_constants(inputs, {}, params).first_cascade, 2U);
  EXPECT_EQ(epipolar_constants(inputs, {}, params).cascades, 5U);
  params.scattering.light_shafts = false;
  EXPECT_EQ(epipolar_constants(inputs, {}, params).first_cascade, 0U);
  EXPECT_EQ(epipolar_constants(inputs, {}, params).cascades, 0U);
  EffectDesc desc;
  for (const auto& [texels, cells] :
       {std::pair(1U, 256U), {256U, 256U}, {257U, 512U}, {1024U, 1024U}, {16384U, 16384U}}) {
    desc.max_shadow_resolution = texels;
    EXPECT_EQ(tree_cells(desc), cells);
    EXPECT_EQ(epipolar_constants(inputs, desc, params).tree_cells, cells);
  }
}

VkDeviceSize total(const FrameBufferSizes& sizes) {
  VkDeviceSize sum = 0;
  for (const VkDeviceSize size : sizes.bytes) sum += size;
  return sum;
}

TEST(FrameBufferSizes, FollowTheParameters) {
  EffectDesc desc;
  const Params defaults;
  const FrameBufferSizes usual = frame_buffer_sizes(desc, defaults);
  for (const VkDeviceSize size : usual.bytes) EXPECT_GT(size, 0U);
  // The promised limit for the defaults, for pictures of 1280 x 720 and larger.
  EXPECT_LE(total(usual), VkDeviceSize{64} << 20);

  Params params;
  params.scattering.technique = Technique::brute_force;
  EXPECT_EQ(total(frame_buffer_sizes(desc, params)), 0U);

  params = {};
  params.epipolar.slices *= 2;
  const FrameBufferSizes twice = frame_buffer_sizes(desc, params);
  for (const Resource buffer :
       {Resource::slices, Resource::slice_lines, Resource::samples, Resource::coarse_inscattering,
        Resource::interpolation_sources, Resource::min_max_tree}) {
    EXPECT_EQ(twice[buffer], 2 * usual[buffer]) << name_of(buffer);
  }
  params = {};
  params.epipolar.samples *= 2;
  const FrameBufferSizes longer = frame_buffer_sizes(desc, params);
  EXPECT_EQ(longer[Resource::samples], 2 * usual[Resource::samples]);
  EXPECT_EQ(longer[Resource::min_max_tree], usual[Resource::min_max_tree]);

  params = {};
  params.epipolar.min_max_format = MinMaxFormat::float32;
  EXPECT_EQ(frame_buffer_sizes(desc, params)[Resource::min_max_tree], 2 * usual[Resource::min_max_tree]);
  params.epipolar.min_max_tree = false;
  EXPECT_LT(frame_buffer_sizes(desc, params)[Resource::min_max_tree], 1024U);

  params = {};
  params.shadows.cascade_processing = CascadeProcessing::multi_pass;
  const VkDeviceSize one = frame_buffer_sizes(desc, params)[Resource::march_states];
  EXPECT_GT(one, usual[Resource::march_states]);
  params.shadows.cascade_processing = CascadeProcessing::multi_pass_instanced;
  EXPECT_EQ(frame_buffer_sizes(desc, params)[Resource::march_states], desc.max_cascades * one);

  const VkDeviceSize pixels = VkDeviceSize{desc.max_extent.width} * desc.max_extent.height;
  EXPECT_GE(usual[Resource::corrected_inscattering], pixels / 8 * 8);
  EXPECT_LT(usual[Resource::corrected_inscattering], pixels * 2);
  params = {};
  params.epipolar.correct_depth_breaks = true;
  const FrameBufferSizes all = frame_buffer_sizes(desc, params);
  EXPECT_GE(all[Resource::corrected_inscattering], pixels * 8);
  EXPECT_GE(all[Resource::correction_list], pixels * 4);
  EXPECT_LT(usual[Resource::downscaled_inscattering], 1024U);
  params = {};
  params.scattering.downscale = 2;
  EXPECT_GE(frame_buffer_sizes(desc, params)[Resource::downscaled_inscattering], pixels / 4 * 16);
  desc.max_cascades *= 2;
  EXPECT_EQ(frame_buffer_sizes(desc, {})[Resource::min_max_tree], 2 * usual[Resource::min_max_tree]);
  EXPECT_EQ(frame_buffer_sizes(desc, {})[Resource::slice_lines], 2 * usual[Resource::slice_lines]);
  EXPECT_EQ(frame_buffer_sizes(desc, {})[Resource::samples], usual[Resource::samples]);
}

TEST(EpipolarSteps, InitialSamplesStandCloserInTwilight) {
  const auto step_at = [](double elevation_deg, const Params& params) {
    const double e = elevation_deg * std::numbers::pi / 180.0;
    return with_sun({0.0F, static_cast<float>(std::sin(e)), static_cast<float>(-std::cos(e))}, params).initial_step;
  };
  Params params;
  const std::uint32_t usual = params.epipolar.initial_step;
  for (const double elevation_deg : {90.0, 6.0, 0.0, -0.9})
    EXPECT_EQ(step_at(elevation_deg, params), usual) << elevation_deg;
  for (const double elevation_deg : {-1.1, -7.0, -18.0})
    EXPECT_EQ(step_at(elevation_deg, params), usual / 4) << elevation_deg;
  params.epipolar.initial_step = 1;
  EXPECT_EQ(step_at(-7.0, params), 1U);
  // The sun lights a homogeneous medium at night too.
  params = {};
  params.scattering.medium = MediumKind::homogeneous;
  EXPECT_EQ(step_at(-7.0, params), usual);
}

TEST(EpipolarSteps, InitialSamplesStandCloserWithClouds) {
  FrameInputs inputs = level_view();
  const Params params;
  EXPECT_EQ(epipolar_constants(inputs, {}, params).initial_step, params.epipolar.initial_step);
  inputs.clouds.map.view = reinterpret_cast<VkImageView>(std::uintptr_t{1});
  EXPECT_EQ(epipolar_constants(inputs, {}, params).initial_step, params.epipolar.initial_step / 4);
}

}  // namespace
}  // namespace tyndall
