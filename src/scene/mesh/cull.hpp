// Whether a box can be in sight: of the camera or of a shadow cascade.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/mesh/mesh_data.hpp"

namespace tyndall::scene {

// The four sides of what a projection shows; what is nearer or farther is left to it. A point is inside where
// dot(side, (p, 1)) >= 0 for all of them.
struct Sides {
  std::array<glm::dvec4, 4> planes;
};
[[nodiscard]] inline Sides sides_of(const glm::dmat4& clip_from_world) {
  const glm::dmat4 rows = glm::transpose(clip_from_world);
  return {{rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1]}};
}

// Never true for a box of which a point is inside all sides; false too for some that are outside near a corner.
[[nodiscard]] inline bool is_outside(const Sides& sides, const Box& box) {
  const glm::dvec3 middle = 0.5 * (box.min + box.max);
  const glm::dvec3 half = 0.5 * (box.max - box.min);
  for (const glm::dvec4& side : sides.planes) {
    const glm::dvec3 normal(side);
    if (glm::dot(normal, middle) + glm::dot(glm::abs(normal), half) + side.w < 0.0) return true;
  }
  return false;
}

// The box around a transformed box, with room for the single precision that vertices are transformed in.
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
