// The coordinate frame in which a view is drawn. Single precision resolves centimetres only within a hundred kilometres
// of the origin. Everything on the device, the effect included, is therefore relative to a point on the planet's
// surface below the camera: the origin is there, y points up and the planet's centre is at (0, -radius, 0), as in the
// library's world. Everything on the host stays in the world frame, in double precision. The origin moves in steps, so
// that rounding does not change with every movement of the camera. At the origin of the world both frames are equal.
#pragma once

#include <glm/glm.hpp>

#include "scene/view/map_projection_constants.hpp"

namespace tyndall::scene {

struct LocalFrame {
  int projection = 0;     // map projection that the terrain's grid uses
  glm::dvec2 map_m = {};  // the frame's origin in that projection
  glm::dmat4 world_from_local = glm::dmat4(1.0);
  glm::dmat4 local_from_world = glm::dmat4(1.0);

  [[nodiscard]] glm::dvec3 place(const glm::dvec3& world) const { return local_from_world * glm::dvec4(world, 1.0); }
  [[nodiscard]] glm::dvec3 direction(const glm::dvec3& world) const {
    return local_from_world * glm::dvec4(world, 0.0);
  }
};

// Returns the frame of a camera at a position in the world.
[[nodiscard]] LocalFrame local_frame(const glm::dvec3& position, double radius_m);
[[nodiscard]] shared::MapProjections map_projections_of(const LocalFrame& frame, double radius_m);

}  // namespace tyndall::scene
