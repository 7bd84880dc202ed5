#include "scene/description/map_projection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tyndall::scene {
namespace {

// The terrains of two map projections are blended where the cosines of the angles from their centres differ by less
// than this. shaders/scene/map_projections.glsl has the same value.
constexpr double kBlend = 0.08;

std::array<double, kMapProjectionCount> cosines_of(const glm::dvec3& up) {
  std::array<double, kMapProjectionCount> out = {};
  for (int projection = 0; projection < kMapProjectionCount; ++projection)
    out[static_cast<std::size_t>(projection)] = glm::dot(up, projection_frame(projection)[1]);
  return out;
}

}  // namespace

const glm::dmat3& projection_frame(int projection) {
  static const std::array<glm::dmat3, kMapProjectionCount> frames = {{
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
      {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
      {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
      {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
      {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
      {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
  }};
  return frames[static_cast<std::size_t>(projection)];
}

int nearest_projection(const glm::dvec3& up) {
  const std::array<double, kMapProjectionCount> cosines = cosines_of(up);
  return static_cast<int>(std::max_element(cosines.begin(), cosines.end()) - cosines.begin());
}

std::array<double, kMapProjectionCount> projection_weights(const glm::dvec3& up) {
  std::array<double, kMapProjectionCount> out = cosines_of(up);
  const double nearest = *std::max_element(out.begin(), out.end());
  double sum = 0.0;
  for (double& weight : out) {
    const double x = std::clamp(1.0 - (nearest - weight) / kBlend, 0.0, 1.0);
    weight = x * x * (3.0 - 2.0 * x);
    sum += weight;
  }
  for (double& weight : out) weight /= sum;
  return out;
}

glm::dvec3 world_from_projection(int projection, double x, double z, double altitude_m, double radius_m) {
  const glm::dvec3 p = world_from_map(x, z, altitude_m, radius_m);
  if (projection == 0) return p;
  const glm::dvec3 centre(0.0, -radius_m, 0.0);
  return centre + projection_frame(projection) * (p - centre);
}

glm::dvec2 projection_from_up(int projection, const glm::dvec3& up, double radius_m) {
  const glm::dvec3 p = glm::transpose(projection_frame(projection)) * up;
  const double horizontal = std::hypot(p.x, p.z);
  const double arc_m = std::atan2(horizontal, p.y) * radius_m;
  if (horizontal == 0.0) return {arc_m, 0.0};
  return {p.x / horizontal * arc_m, p.z / horizontal * arc_m};
}

glm::dvec3 world_from_map(double x, double z, double altitude_m, double radius_m) {
  const double arc = std::hypot(x, z) / radius_m;
  const double sine_per_arc = arc > 1e-9 ? std::sin(arc) / arc : 1.0;
  const double scale = sine_per_arc * (radius_m + altitude_m) / radius_m;
  const double half = std::sin(0.5 * arc);
  return {x * scale, altitude_m * std::cos(arc) - 2.0 * radius_m * half * half, z * scale};
}

glm::dvec2 map_from_world(const glm::dvec3& p, double radius_m) {
  return projection_from_up(0, up_of(p, radius_m), radius_m);
}

double altitude_of(const glm::dvec3& p, double radius_m) {
  const double distance = std::hypot(p.x, p.y + radius_m, p.z);
  return (p.x * p.x + p.z * p.z + p.y * (2.0 * radius_m + p.y)) / (distance + radius_m);
}

glm::dvec3 up_of(const glm::dvec3& p, double radius_m) {
  const glm::dvec3 from_centre(p.x, p.y + radius_m, p.z);
  const double distance = glm::length(from_centre);
  return distance > 0.0 ? from_centre / distance : glm::dvec3(0, 1, 0);
}

glm::dvec3 at_altitude(const glm::dvec3& p, double altitude_m, double radius_m) {
  return p + up_of(p, radius_m) * (altitude_m - altitude_of(p, radius_m));
}

glm::dvec3 east_of(const glm::dvec3& up) {
  const glm::dvec3 east = glm::dvec3(1, 0, 0) - up * up.x;
  const double length = glm::length(east);
  if (length > 1e-9) return east / length;
  return {0.0, up.x > 0.0 ? -1.0 : 1.0, 0.0};
}

}  // namespace tyndall::scene
