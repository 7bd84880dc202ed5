#include "scene/chart.hpp"

#include <cmath>

namespace tyndall::scene {

glm::dvec3 world_from_map(double x, double z, double altitude_m, double radius_m) {
  const double arc = std::hypot(x, z) / radius_m;
  const double sine_per_arc = arc > 1e-9 ? std::sin(arc) / arc : 1.0;
  const double scale = sine_per_arc * (radius_m + altitude_m) / radius_m;
  const double half = std::sin(0.5 * arc);
  return {x * scale, altitude_m * std::cos(arc) - 2.0 * radius_m * half * half, z * scale};
}

glm::dvec2 map_from_world(const glm::dvec3& p, double radius_m) {
  const double horizontal = std::hypot(p.x, p.z);
  if (horizontal < 1e-9) return {0.0, 0.0};
  const double arc = std::atan2(horizontal, p.y + radius_m);
  return {p.x / horizontal * arc * radius_m, p.z / horizontal * arc * radius_m};
}

double altitude_of(const glm::dvec3& p, double radius_m) {
  const double distance = std::hypot(p.x, p.y + radius_m, p.z);
  return (p.x * p.x + p.z * p.z + p.y * (2.0 * radius_m + p.y)) / (distance + radius_m);
}

glm::dvec3 up_of(const glm::dvec3& p, double radius_m) {
  return glm::normalize(glm::dvec3(p.x, p.y + radius_m, p.z));
}

}  // namespace tyndall::scene
