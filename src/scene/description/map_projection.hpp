// Positions on the planet. World: the planet's centre is at (0, -radius, 0), y points up at the origin. Double
// precision.
//
// The map lays the ground on the planet: x east and z south [m] are arc lengths from the origin of the world, azimuthal
// equidistant. It is true to scale at the origin, stretched by 1.11 at 5000 km, and tears at the antipode. So the
// planet has six such map projections, whose centres are the origin, its antipode and the four points between them;
// each is used where its centre is the nearest, out to 55 degrees, where it is stretched by 1.17. The map is map
// projection 0.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "tyndall/types.hpp"

namespace tyndall::scene {

constexpr int kMapProjectionCount = 6;  // origin, east, west, south, north, antipode

// Columns: east, up and south at a map projection's centre, in the world.
[[nodiscard]] const glm::dmat3& projection_frame(int projection);
// The map projection whose centre is the nearest to where `up` points from the planet's centre.
[[nodiscard]] int nearest_projection(const glm::dvec3& up);
// How much each map projection's terrain counts there: together one, and more than one of them only within 0.06 rad of
// where two centres are equally near.
[[nodiscard]] std::array<double, kMapProjectionCount> projection_weights(const glm::dvec3& up);
// World position of the point at altitude_m over map coordinates (x, z) of a map projection, and the coordinates of the
// point in the direction `up` from the planet's centre. At a map projection's antipode, which has no place of its own,
// a point due east.
[[nodiscard]] glm::dvec3 world_from_projection(int projection, double x, double z, double altitude_m, double radius_m);
[[nodiscard]] glm::dvec2 projection_from_up(int projection, const glm::dvec3& up, double radius_m);

// The same of the map.
[[nodiscard]] glm::dvec3 world_from_map(double x, double z, double altitude_m, double radius_m);
[[nodiscard]] glm::dvec2 map_from_world(const glm::dvec3& p, double radius_m);

[[nodiscard]] inline glm::dvec3 to_glm(const DVec3& v) { return {v.x, v.y, v.z}; }

[[nodiscard]] double altitude_of(const glm::dvec3& p, double radius_m);
// Unit vector away from the planet's centre.
[[nodiscard]] glm::dvec3 up_of(const glm::dvec3& p, double radius_m);
// The point at altitude_m above or below a world position.
[[nodiscard]] glm::dvec3 at_altitude(const glm::dvec3& p, double altitude_m, double radius_m);
// Horizontal unit vector to the east, along the world's x axis; where that is vertical, the one that is met on the way
// from the origin.
[[nodiscard]] glm::dvec3 east_of(const glm::dvec3& up);

}  // namespace tyndall::scene
