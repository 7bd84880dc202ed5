// Culling: tests whether a box can be visible to the camera or to a shadow cascade.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/mesh/mesh_data.hpp"

namespace tyndall::scene {

// The four side planes of a frustum. Near and far planes are not tested. A point p is inside if dot(side, (p, 1)) >= 0
// for all of them.
struct Sides {
  std::array<glm::dvec4, 4> planes;
};
[[nodiscard]] inline Sides sides_of(const glm::dmat4& clip_from_world) {
  const glm::dmat4 rows = glm::transpose(clip_from_world);
  return {{rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1]}};
}

// Returns whether a box is outside one of the planes. The test is conservative: it may return false for a box that is
// outside near a corner, but never true for a box that is partly inside.
[[nodiscard]] inline bool is_outside(const Sides& sides, const Box& box) {
  const glm::dvec3 middle = 0.5 * (box.min + box.max);
  const glm::dvec3 half = 0.5 * (box.max - box.min);
  for (const glm::dvec4& side : sides.planes) {
    const glm::dvec3 normal(side);
    if (glm::dot(normal, middle) + glm::dot(glm::abs(normal), half) + side.w < 0.0) return true;
  }
  return false;
}

// Returns the bounds of a transformed box, enlarged by the rounding errors of vertices in single precision.
[[nodiscard]] inline Box placed_box(const glm::dmat4& world_from_mesh, const Box& box) {
  const glm::dvec3 middle(world_from_mesh * glm::dvec4(0.5 * (box.min + box.max), 1.0));
  const glm::dvec3 half = 0.5 * (box.max - box.min);
  glm::dvec3 reach(0.0);
  for (int i = 0; i < 3; ++i) reach += glm::abs(glm::dvec3(world_from_mesh[i])) * half[i];
  reach += 1e-6 * (glm::abs(middle) + reach) + 1e-3;
  Box out;
  out.min = middle - reach;
  out.max = middle + reach;
  return out;
}

}  // namespace tyndall::scene
