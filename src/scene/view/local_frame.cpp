#include "scene/view/local_frame.hpp"

#include <algorithm>
#include <cmath>

#include "scene/description/map_projection.hpp"
#include "scene/view/camera.hpp"

namespace tyndall::scene {
namespace {

constexpr double kUnitsPerM = 64.0;
constexpr double kLargestStep_m = 1024.0;

// The position of the origin relative to the centre of a map projection.
struct Radial {
  glm::dvec2 radial = {1, 0};  // unit vector on the map
  double arc = 0.0;
  glm::dvec3 outwards = {};  // the horizontal direction away from the centre, in the world
};

Radial radial_of(int projection, const glm::dvec2& map, double radius_m) {
  const glm::dmat3& axes = projection_frame(projection);
  Radial out;
  const double distance = glm::length(map);
  if (distance > 0.0) out.radial = map / distance;
  out.arc = distance / radius_m;
  const glm::dvec3 way = axes[0] * out.radial.x + axes[2] * out.radial.y;
  out.outwards = way * std::cos(out.arc) - axes[1] * std::sin(out.arc);
  return out;
}

// Converts a length in units of 1/64 m to an integer that wraps around as in the shaders.
std::int32_t wrapped(double units) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(units)));
}

}  // namespace

LocalFrame local_frame(const glm::dvec3& position, double radius_m) {
  LocalFrame out;
  const glm::dvec3 up = up_of(position, radius_m);
  out.projection = nearest_projection(up);
  const double step = std::min(kLargestStep_m, std::exp2(std::floor(std::log2(radius_m / 64.0))));
  out.map_m = glm::round(projection_from_up(out.projection, up, radius_m) / step) * step;
  // The axes of the map projection, rotated by the smallest rotation from its centre to the origin.
  const Radial at = radial_of(out.projection, out.map_m, radius_m);
  const glm::dvec3 origin = world_from_projection(out.projection, out.map_m.x, out.map_m.y, 0.0, radius_m);
  const glm::dvec3 zenith = up_of(origin, radius_m);
  const glm::dvec3 across = glm::cross(at.outwards, zenith);
  const glm::dvec3 x = at.outwards * at.radial.x - across * at.radial.y;
  const glm::dvec3 z = at.outwards * at.radial.y + across * at.radial.x;
  out.world_from_local =
      glm::dmat4(glm::dvec4(x, 0.0), glm::dvec4(zenith, 0.0), glm::dvec4(z, 0.0), glm::dvec4(origin, 1.0));
  const glm::dmat3 local_from_world = glm::transpose(glm::dmat3(x, zenith, z));
  out.local_from_world = glm::dmat4(local_from_world);
  out.local_from_world[3] = glm::dvec4(-(local_from_world * origin), 1.0);
  return out;
}

shared::MapProjections map_projections_of(const LocalFrame& frame, double radius_m) {
  shared::MapProjections out = {};
  const glm::dvec3 up(frame.world_from_local[1]);
  for (int projection = 0; projection < kMapProjectionCount; ++projection) {
    const glm::dvec2 map = projection == frame.projection ? frame.map_m : projection_from_up(projection, up, radius_m);
    const Radial at = radial_of(projection, map, radius_m);
    const glm::dvec2 units = glm::floor(map * kUnitsPerM);
    const glm::dvec2 rest = map - units / kUnitsPerM;
    const glm::dvec3 outwards = frame.direction(at.outwards);
    shared::ProjectionLink& link = out.links[projection];
    link.units = {wrapped(units.x), wrapped(units.y)};
    link.rest_m = {static_cast<float>(rest.x), static_cast<float>(rest.y)};
    link.radial = {static_cast<float>(at.radial.x), static_cast<float>(at.radial.y)};
    link.local_radial = {static_cast<float>(outwards.x), static_cast<float>(outwards.z)};
    link.radius_m = static_cast<float>(at.arc * radius_m);
    link.sine = static_cast<float>(std::sin(at.arc));
    link.cosine = static_cast<float>(std::cos(at.arc));
  }
  out.world_x = to_vec3(frame.direction({1, 0, 0}));
  out.world_y = to_vec3(frame.direction({0, 1, 0}));
  out.world_z = to_vec3(frame.direction({0, 0, 1}));
  out.planet_radius_m = static_cast<float>(radius_m);
  out.own = static_cast<std::uint32_t>(frame.projection);
  return out;
}

}  // namespace tyndall::scene
