// The frame that a view is drawn in. Floats are fine to centimetres only within a hundred kilometres of their origin,
// so what goes to the device, the effect included, is relative to a point of the planet's surface below the camera:
// origin there, y up, planet centre at (0, -radius, 0), as the library's world has it. Everything on the host stays in
// the world, in double precision. The origin moves in steps, so that what is rounded does not change with every step of
// the camera; at the origin of the world both frames are the same.
#pragma once

#include <glm/glm.hpp>

#include "scene/view/map_projection_constants.hpp"

namespace tyndall::scene {

struct LocalFrame {
  int projection = 0;     // the map projection of the terrain's grid
  glm::dvec2 map_m = {};  // the origin of the frame in it
  glm::dmat4 world_from_local = glm::dmat4(1.0);
  glm::dmat4 local_from_world = glm::dmat4(1.0);

  [[nodiscard]] glm::dvec3 place(const glm::dvec3& world) const { return local_from_world * glm::dvec4(world, 1.0); }
  [[nodiscard]] glm::dvec3 direction(const glm::dvec3& world) const {
    return local_from_world * glm::dvec4(world, 0.0);
  }
};

// The frame of a camera at a world position.
[[nodiscard]] LocalFrame local_frame(const glm::dvec3& position, double radius_m);
[[nodiscard]] shared::MapProjections map_projections_of(const LocalFrame& frame, double radius_m);

}  // namespace tyndall::scene
