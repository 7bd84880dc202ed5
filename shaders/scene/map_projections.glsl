// Conversions between the planet's maps and the local frame in single precision without cancellation: positions are
// offsets from the origin of the local frame, and all formulas use differences, so that errors are a few 1e-7 of the
// offset. The maps are azimuthal equidistant projections: a point at the arc a from a projection's centre is at the
// distance R a from it on the map.
#ifndef TYNDALL_MAP_PROJECTIONS_GLSL
#define TYNDALL_MAP_PROJECTIONS_GLSL

#include "scene/map_projections.h"

layout(std430, binding = 13) readonly buffer map_projections_block { MapProjections map_projections; };

const float kHalfTurn = 3.14159265;

// Returns the sine with a relative error of 1e-7. Vulkan only guarantees an error of 2^-11, which is kilometres on a
// planet.
float exact_sin(float x) {
  float turns = floor(x / (2.0 * kHalfTurn) + 0.5);
  float y = x - turns * (2.0 * kHalfTurn);
  if (abs(y) > 0.5 * kHalfTurn) y = (y > 0.0 ? kHalfTurn : -kHalfTurn) - y;
  float s = y * y;
  return y * (1.0 + s * (-1.0 / 6.0 + s * (1.0 / 120.0 + s * (-1.0 / 5040.0 + s * (1.0 / 362880.0 - s / 39916800.0)))));
}

// Returns the angle of (cosine, sine) in [-pi; pi] with the same precision, from the tangent of an eighth of it.
float exact_angle(float sine, float cosine) {
  float tangent = cosine > -0.5 ? sine / (1.0 + cosine) : (1.0 - cosine) / (abs(sine) > 1e-12 ? sine : 1e-12);
  tangent /= 1.0 + sqrt(1.0 + tangent * tangent);
  tangent /= 1.0 + sqrt(1.0 + tangent * tangent);
  float s = tangent * tangent;
  return 8.0 * tangent * (1.0 - s * (1.0 / 3.0 - s * (1.0 / 5.0 - s * (1.0 / 7.0 - s * (1.0 / 9.0 - s / 11.0)))));
}

// Returns the vector rotated by a quarter turn from east to south.
vec2 turned(vec2 v) { return vec2(-v.y, v.x); }

// The position of a point in polar coordinates around a projection's centre. The azimuth is counted from the direction
// of the local frame's origin and stored as versine (1 - cos) and sine, which are precise for small angles.
struct Azimuth {
  float distance_from_centre;
  float versine;
  float sine;
};

Azimuth azimuth_of(float along, float across) {
  Azimuth a;
  a.distance_from_centre = sqrt(along * along + across * across);
  float inverse = a.distance_from_centre > 0.0 ? 1.0 / a.distance_from_centre : 0.0;
  a.sine = across * inverse;
  a.versine = along > 0.0                    ? across * across * inverse / (a.distance_from_centre + along)
              : a.distance_from_centre > 0.0 ? 1.0 - along * inverse
                                             : 0.0;
  return a;
}

// Returns the point of the unit sphere for a position on the projection of the terrain's grid, minus the one for the
// origin of the local frame. offset_m: the position relative to that origin, on the map.
vec3 local_direction(vec2 offset_m) {
  ProjectionLink c = map_projections.links[map_projections.own];
  float radial_m = dot(offset_m, c.radial);
  float across_m = dot(offset_m, turned(c.radial));
  Azimuth azimuth = azimuth_of(c.radius_m + radial_m, across_m);
  float rho = azimuth.distance_from_centre;
  float sum_m = rho + c.radius_m;
  // (rho - c.radius_m) / R
  float arc = sum_m > 0.0 ? (radial_m * (2.0 * c.radius_m + radial_m) + across_m * across_m) /
                                (sum_m * map_projections.planet_radius_m)
                          : 0.0;
  float sine = exact_sin(rho / map_projections.planet_radius_m);
  float half_sine = exact_sin(0.5 * arc);
  float radial = exact_sin(arc) - sine * c.cosine * azimuth.versine;
  float tangential = sine * azimuth.sine;
  vec2 level = c.local_radial * radial + turned(c.local_radial) * tangential;
  return vec3(level.x, -2.0 * half_sine * half_sine - sine * c.sine * azimuth.versine, level.y);
}

// Returns the position in the local frame at an altitude over a point of the unit sphere.
vec3 local_position(vec3 direction, float altitude_m) {
  return direction * (map_projections.planet_radius_m + altitude_m) + vec3(0.0, altitude_m, 0.0);
}

// Returns the position on the projection `index` for a point of the unit sphere [1/64 m].
ivec2 projection_units(uint index, vec3 direction) {
  ProjectionLink c = map_projections.links[index];
  float radial = dot(direction.xz, c.local_radial);
  float tangential = dot(direction.xz, turned(c.local_radial));
  Azimuth azimuth = azimuth_of(c.sine * (1.0 + direction.y) + c.cosine * radial, tangential);
  float sine = azimuth.distance_from_centre;
  float arc =
      exact_angle(radial + sine * c.cosine * azimuth.versine, 1.0 + direction.y + sine * c.sine * azimuth.versine);
  float way_m = arc * map_projections.planet_radius_m;
  float rho = c.radius_m + way_m;
  vec2 offset_m = c.radial * (way_m - rho * azimuth.versine) + turned(c.radial) * (rho * azimuth.sine) + c.rest_m;
  return c.units + ivec2(floor(offset_m * 64.0 + 0.5));
}

// Computes the weight of each projection's terrain at a point of the unit sphere: see projection_weights in
// src/scene/description/map_projection.hpp. Returns a bit for each projection with a positive weight. Iterate as `while
// (rest != 0u)`: devices with masked lanes would execute all six iterations of a loop over all projections.
uint projection_weights(vec3 direction, out float weights[6]) {
  vec3 n = direction + vec3(0.0, 1.0, 0.0);
  vec3 world = vec3(dot(map_projections.world_x, n), dot(map_projections.world_y, n), dot(map_projections.world_z, n));
  float cosines[6] = float[6](world.y, world.x, -world.x, world.z, -world.z, -world.y);
  float nearest = -1.0;
  for (int i = 0; i < 6; ++i) nearest = max(nearest, cosines[i]);
  float sum = 0.0;
  for (int i = 0; i < 6; ++i) {
    float x = clamp(1.0 - (nearest - cosines[i]) / 0.08, 0.0, 1.0);
    weights[i] = x * x * (3.0 - 2.0 * x);
    sum += weights[i];
  }
  uint counting = 0u;
  for (int i = 0; i < 6; ++i) {
    weights[i] /= sum;
    counting |= weights[i] > 0.0 ? 1u << i : 0u;
  }
  return counting;
}

// The axes of a projection at a point, as unit vectors in the local frame, and how much the projection stretches
// lengths at right angles to the direction from its centre.
struct ProjectionAxes {
  vec3 up;
  vec3 radial;  // away from the map projection's centre
  vec3 tangential;
  vec2 map_radial;  // `radial` on the map
  float stretch;
};

// Returns the axes of projection `index`. direction: the point of the unit sphere minus the one for the local origin.
ProjectionAxes projection_axes(uint index, vec3 direction) {
  ProjectionLink c = map_projections.links[index];
  float radial = dot(direction.xz, c.local_radial);
  float tangential = dot(direction.xz, turned(c.local_radial));
  Azimuth azimuth = azimuth_of(c.sine * (1.0 + direction.y) + c.cosine * radial, tangential);
  float sine = azimuth.distance_from_centre;
  float cosine = c.cosine * (1.0 + direction.y) - c.sine * radial;
  float turn = 1.0 - azimuth.versine;
  ProjectionAxes a;
  a.up = normalize(direction + vec3(0.0, 1.0, 0.0));
  vec2 level =
      c.local_radial * (cosine * turn * c.cosine + sine * c.sine) + turned(c.local_radial) * (cosine * azimuth.sine);
  a.radial = normalize(vec3(level.x, cosine * turn * c.sine - sine * c.cosine, level.y));
  a.tangential = cross(a.radial, a.up);
  a.map_radial = c.radial * turn + turned(c.radial) * azimuth.sine;
  a.stretch = sine > 1e-4 ? exact_angle(sine, cosine) / sine : 1.0;
  return a;
}

// Returns the surface's normal in the local frame for a gradient of the elevation on the map.
vec3 normal_from_gradient(vec2 gradient, ProjectionAxes a) {
  return normalize(a.up - a.radial * dot(gradient, a.map_radial) -
                   a.tangential * (dot(gradient, turned(a.map_radial)) * a.stretch));
}

// Convert directions between the local frame and the map: x east, y up, z south.
vec3 map_from_local(vec3 v, ProjectionAxes a) {
  vec2 level = a.map_radial * dot(v, a.radial) + turned(a.map_radial) * dot(v, a.tangential);
  return vec3(level.x, dot(v, a.up), level.y);
}
vec3 local_from_map(vec3 v, ProjectionAxes a) {
  return a.radial * dot(v.xz, a.map_radial) + a.up * v.y + a.tangential * dot(v.xz, turned(a.map_radial));
}

#endif
