// The hall, which light enters only through glass; and culling.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/mesh/cull.hpp"
#include "scene/mesh/hall.hpp"

namespace tyndall::scene {
namespace {

// Returns the first triangle that a ray hits, or -1.
int first_hit(const MeshData& data, const glm::dvec3& from, const glm::dvec3& direction, double& nearest) {
  int hit = -1;
  nearest = std::numeric_limits<double>::max();
  for (std::size_t t = 0; t + 2 < data.indices.size(); t += 3) {
    const glm::dvec3 a(data.vertices[data.indices[t]].position);
    const glm::dvec3 e1 = glm::dvec3(data.vertices[data.indices[t + 1]].position) - a;
    const glm::dvec3 e2 = glm::dvec3(data.vertices[data.indices[t + 2]].position) - a;
    const glm::dvec3 p = glm::cross(direction, e2);
    const double det = glm::dot(e1, p);
    if (std::abs(det) < 1e-12) continue;
    const glm::dvec3 s = from - a;
    const double u = glm::dot(s, p) / det;
    const glm::dvec3 q = glm::cross(s, e1);
    const double v = glm::dot(direction, q) / det;
    const double d = glm::dot(e2, q) / det;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || d <= 0.0 || d >= nearest) continue;
    nearest = d;
    hit = static_cast<int>(t);
  }
  return hit;
}

TEST(SceneHall, IsClosedAndSeenFromInside) {
  const MeshData hall = make_hall();
  EXPECT_NEAR(hall.bounds.min.y, 0.0, 1e-9);
  EXPECT_LT(hall.bounds.max.y, 17.0);
  ASSERT_FALSE(hall.parts.empty());
  for (const std::uint32_t index : hall.indices) ASSERT_LT(index, hall.vertices.size());
  for (const MeshVertex& v : hall.vertices) ASSERT_NEAR(glm::length(v.normal), 1.0F, 1e-4F);
  const auto material_of = [&](int triangle) -> const MeshMaterial& {
    for (const MeshPart& part : hall.parts) {
      if (static_cast<std::uint32_t>(triangle) >= part.first_index &&
          static_cast<std::uint32_t>(triangle) < part.first_index + part.index_count) {
        return hall.materials[part.material];
      }
    }
    return hall.materials.back();
  };
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int glass = 0;
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 from(-2.8 + 5.6 * unit(engine), 1.2 + 6.0 * unit(engine), -17.0 + 34.0 * unit(engine));
    const double z = 2.0 * unit(engine) - 1.0;
    const double angle = 6.283185307179586 * unit(engine);
    const glm::dvec3 direction(std::sqrt(1.0 - z * z) * std::cos(angle), z, std::sqrt(1.0 - z * z) * std::sin(angle));
    double distance = 0.0;
    const int hit = first_hit(hall, from, direction, distance);
    ASSERT_GE(hit, 0) << "a hole: from " << from.x << " " << from.y << " " << from.z << " towards " << direction.x
                      << " " << direction.y << " " << direction.z;
    const MeshMaterial& material = material_of(hit);
    glass += material.transmits() ? 1 : 0;
    const auto p = [&](int k) {
      return glm::dvec3(
          hall.vertices[hall.indices[static_cast<std::size_t>(hit) + static_cast<std::size_t>(k)]].position);
    };
    const double facing = glm::dot(glm::cross(p(1) - p(0), p(2) - p(0)), direction);
    if (facing > 0.0 && !material.double_sided) {
      const glm::dvec3 where = from + direction * distance;
      ADD_FAILURE() << material.name << " seen from behind at " << where.x << " " << where.y << " " << where.z;
    }
  }
  EXPECT_GT(glass, 60);
}

// Boxes with a visible point are never left out; boxes entirely on the outer side of one plane are.
TEST(SceneMeshCulling, CullsOnlyInvisibleBoxes) {
  std::mt19937 engine(6);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  int outside = 0;
  for (int i = 0; i < 2000; ++i) {
    // A perspective along -z with an infinite far plane, or a box as for a cascade; rotated and moved.
    glm::dmat4 clip(0.0);
    clip[0][0] = uniform(0.5, 3.0);
    clip[1][1] = uniform(0.5, 3.0);
    if (i % 2 == 0) {
      clip[2][3] = -1.0;
      clip[3][2] = 0.5;
    } else {
      clip[0][0] *= 0.1;
      clip[1][1] *= 0.1;
      clip[3][3] = 1.0;
    }
    const double turn = uniform(0.0, 6.28);
    const glm::dmat4 view(std::cos(turn), 0, std::sin(turn), 0, 0, 1, 0, 0, -std::sin(turn), 0, std::cos(turn), 0,
                          uniform(-20, 20), uniform(-20, 20), uniform(-20, 20), 1);
    clip = clip * view;
    Box box;
    const glm::dvec3 corner(uniform(-30, 30), uniform(-30, 30), uniform(-30, 30));
    box.add(corner);
    box.add(corner + glm::dvec3(uniform(0, 20), uniform(0, 20), uniform(0, 20)));
    const bool left_out = is_outside(sides_of(clip), box);
    outside += left_out ? 1 : 0;
    for (int k = 0; k < 64 && left_out; ++k) {
      const glm::dvec3 p = glm::mix(box.min, box.max, glm::dvec3(uniform(0, 1), uniform(0, 1), uniform(0, 1)));
      const glm::dvec4 seen = clip * glm::dvec4(p, 1.0);
      EXPECT_FALSE(std::abs(seen.x) <= seen.w && std::abs(seen.y) <= seen.w) << i;
    }
    // Behind the camera or beside the cascade, no point of a small box is visible.
    Box point;
    point.add(corner);
    const glm::dvec4 seen = clip * glm::dvec4(corner, 1.0);
    EXPECT_EQ(is_outside(sides_of(clip), point), std::abs(seen.x) > seen.w || std::abs(seen.y) > seen.w) << i;
  }
  EXPECT_GT(outside, 400);
  EXPECT_LT(outside, 1900);
  // A transformed box contains its corners, also when mirrored and rotated.
  const glm::dmat4 place(0, 2, 0, 0, -3, 0, 0, 0, 0, 0, -1, 0, 5, 6, 7, 1);
  Box box;
  box.add(glm::dvec3(-1, -2, -3));
  box.add(glm::dvec3(4, 5, 6));
  const Box placed = placed_box(place, box);
  EXPECT_LE(glm::distance(placed.min, glm::dvec3(-10, 4, 1)), 0.01);
  EXPECT_LE(glm::distance(placed.max, glm::dvec3(11, 14, 10)), 0.01);
}

}  // namespace
}  // namespace tyndall::scene
