// tyndall/conventions.hpp: a point and its picture are the same in the conventions of an engine and of Tyndall.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tyndall/conventions.hpp"

namespace tyndall::conventions {
namespace {

using Point = std::array<float, 4>;

Point times(const Mat4& m, const Point& p) {
  Point out = {};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t i = 0; i < 4; ++i) out[row] += m.m[4 * i + row] * p[i];
  }
  return out;
}

void expect_near(const Point& a, const Point& b, float tolerance = 1e-5F) {
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

// Determinant of the upper 3 x 3 part.
float handedness(const Mat4& m) {
  const float* const e = m.m;
  return e[0] * (e[5] * e[10] - e[9] * e[6]) - e[4] * (e[1] * e[10] - e[9] * e[2]) + e[8] * (e[1] * e[6] - e[5] * e[2]);
}

struct World {
  const char* name;
  Mat4 matrix;
  Point east, up, south;  // in the axes of the engine
  bool left_handed;
};
const World kWorlds[] = {
    {"same", kSame, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, false},
    {"z up", kZUp, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, false},
    {"left-handed", kLeftHanded, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 0}, true},
    {"left-handed, z up", kLeftHandedZUp, {0, 1, 0, 0}, {0, 0, 1, 0}, {-1, 0, 0, 0}, true},
};

TEST(Conventions, WorldsHaveEastUpAndSouthOfTyndall) {
  for (const World& world : kWorlds) {
    SCOPED_TRACE(world.name);
    expect_near(times(world.matrix, world.east), {1, 0, 0, 0});
    expect_near(times(world.matrix, world.up), {0, 1, 0, 0});
    expect_near(times(world.matrix, world.south), {0, 0, 1, 0});
    EXPECT_FLOAT_EQ(handedness(world.matrix), world.left_handed ? -1.0F : 1.0F);
    EXPECT_EQ(product(world.matrix, transposed(world.matrix)), Mat4());
    const Vec3 up = direction(world.matrix, {world.up[0], world.up[1], world.up[2]});
    EXPECT_EQ(up, Vec3(0.0F, 1.0F, 0.0F));
  }
}

TEST(Conventions, ViewsLookDownMinusZ) {
  struct View {
    Mat4 matrix;
    Point forward, up, right;
  };
  const View views[] = {{kSame, {0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}},
                        {kLeftHanded, {0, 0, 1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}},
                        {kLeftHandedZUp, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}},
                        {kLooksDownZ, {0, 0, 1, 0}, {0, -1, 0, 0}, {1, 0, 0, 0}}};
  for (const View& view : views) {
    expect_near(times(view.matrix, view.forward), {0, 0, -1, 0});
    expect_near(times(view.matrix, view.up), {0, 1, 0, 0});
    expect_near(times(view.matrix, view.right), {1, 0, 0, 0});
  }
}

// A point in the world of an engine, through the engine's matrices and through the converted ones.
TEST(Conventions, PointsHaveTheSamePlaceInThePictureAndInTheShadowMap) {
  const float c = std::cos(0.3F), s = std::sin(0.3F);
  const Mat4 engine_view = {{c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 5, -7, 11, 1}};  // rigid
  const Mat4 engine_clip = {{1.2F, 0, 0, 0, 0, 2.0F, 0, 0, 0.1F, -0.2F, 0.001F, 1, 0, 0, 0.1F, 0}};
  const Mat4 engine_shadow = {{0.01F, 0, 0, 0, 0.002F, 0.01F, 0.001F, 0, 0, 0, 0.003F, 0, 0.5F, 0.5F, 0.1F, 1}};
  const Point in_view = {0.7F, -1.3F, 20.0F, 1};
  const Point in_world = times(engine_view, in_view);
  for (const World& world : kWorlds) {
    for (const Mat4& view : {kSame, kLeftHanded, kLeftHandedZUp, kLooksDownZ}) {
      SCOPED_TRACE(world.name);
      const Mat4 converted = world_from_view(world.matrix, engine_view, view);
      expect_near(times(converted, times(view, in_view)), times(world.matrix, in_world), 1e-4F);
      expect_near(times(clip_from_view(engine_clip, view), times(view, in_view)), times(engine_clip, in_view));
      // A left-handed engine has left-handed views, so that the result is a rotation.
      if (world.left_handed == (handedness(view) < 0.0F)) {
        EXPECT_NEAR(handedness(converted), 1.0F, 1e-5F);
      }
    }
    expect_near(times(shadow_from_world(engine_shadow, world.matrix), times(world.matrix, in_world)),
                times(engine_shadow, in_world), 1e-4F);
  }
}

TEST(Conventions, ClipSpacesHaveYDownAndDepthFromZeroToOne) {
  const Mat4 projection = {{1.2F, 0, 0, 0, 0, 2.0F, 0, 0, 0.1F, -0.2F, -1.001F, -1, 0, 0, -0.2F, 0}};
  const Point point = {0.5F, 0.25F, -3.0F, 1};
  const Point clip = times(projection, point);
  expect_near(times(y_flipped(projection), point), {clip[0], -clip[1], clip[2], clip[3]});
  const Point depth = times(depth_from_opengl(projection), point);
  EXPECT_NEAR(depth[2] / depth[3], 0.5F * clip[2] / clip[3] + 0.5F, 1e-6F);
  EXPECT_FLOAT_EQ(depth[3], clip[3]);
  expect_near(times(texture_from_clip(Mat4()), {-1, 1, 0.25F, 1}), {0, 1, 0.25F, 1});
  static_assert(product(Mat4(), kZUp) == kZUp && y_flipped(y_flipped(kZUp)) == kZUp);
}

}  // namespace
}  // namespace tyndall::conventions
