// Positions on the planet. World: the planet's centre is at (0, -radius, 0), y points up at the origin. Double
// precision.
//
// Map coordinates x (east) and z (south) [m] are arc lengths from the origin of the world, in an azimuthal equidistant
// projection. It is true to scale at the origin, stretched by 1.11 at 5000 km, and discontinuous at the antipode. The
// planet therefore has six such projections, whose centres are the origin, its antipode and the four points between
// them. Each is used where its centre is the nearest one, out to 55 degrees, where it is stretched by 1.17. Projection
// 0 is called the map.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "tyndall/types.hpp"

namespace tyndall::scene {

constexpr int kMapProjectionCount = 6;  // origin, east, west, south, north, antipode

// Returns the axes at the centre of a map projection as columns: east, up and south, in the world.
[[nodiscard]] const glm::dmat3& projection_frame(int projection);
// Returns the map projection whose centre is nearest to the direction `up` from the planet's centre.
[[nodiscard]] int nearest_projection(const glm::dvec3& up);
// Returns the weights of the map projections in this direction. Their sum is one. More than one weight is positive only
// near the seams: within 0.06 rad of directions that are equally far from two centres.
[[nodiscard]] std::array<double, kMapProjectionCount> projection_weights(const glm::dvec3& up);
// world_from_projection() returns the world position of map coordinates (x, z) at altitude_m. projection_from_up()
// returns the map coordinates of the direction `up` from the planet's centre. At the antipode of a projection, where
// they are undefined, they are those of a point due east.
[[nodiscard]] glm::dvec3 world_from_projection(int projection, double x, double z, double altitude_m, double radius_m);
[[nodiscard]] glm::dvec2 projection_from_up(int projection, const glm::dvec3& up, double radius_m);

// Convert between coordinates of the map, which is projection 0, and world positions.
[[nodiscard]] glm::dvec3 world_from_map(double x, double z, double altitude_m, double radius_m);
[[nodiscard]] glm::dvec2 map_from_world(const glm::dvec3& p, double radius_m);

[[nodiscard]] inline glm::dvec3 to_glm(const DVec3& v) { return {v.x, v.y, v.z}; }

[[nodiscard]] double altitude_of(const glm::dvec3& p, double radius_m);
// Returns the unit vector away from the planet's centre.
[[nodiscard]] glm::dvec3 up_of(const glm::dvec3& p, double radius_m);
// Returns the point at altitude_m above or below a world position.
[[nodiscard]] glm::dvec3 at_altitude(const glm::dvec3& p, double altitude_m, double radius_m);
// Returns the horizontal unit vector to the east, along the x axis of the world. Where that axis is vertical, returns
// the limit on the way there from the origin.
[[nodiscard]] glm::dvec3 east_of(const glm::dvec3& up);

}  // namespace tyndall::scene
