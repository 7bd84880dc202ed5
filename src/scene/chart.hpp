// The chart that lays the terrain on the planet: map coordinates (x east, z south, metres) are arc
// lengths from the world's origin, azimuthal equidistant. World: planet centre at (0, -radius, 0), y up.
// Double precision; shaders/scene/chart.glsl is the same in single precision.
#pragma once

#include <glm/glm.hpp>

namespace tyndall::scene {

// World position of the point at altitude_m over map coordinates (x, z).
[[nodiscard]] glm::dvec3 world_from_map(double x, double z, double altitude_m, double radius_m);
// Map coordinates of the point of the planet under a world position. The antipode of the origin is singular.
[[nodiscard]] glm::dvec2 map_from_world(const glm::dvec3& p, double radius_m);
[[nodiscard]] double altitude_of(const glm::dvec3& p, double radius_m);
// Unit vector away from the planet's centre.
[[nodiscard]] glm::dvec3 up_of(const glm::dvec3& p, double radius_m);

}  // namespace tyndall::scene
