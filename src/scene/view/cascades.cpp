#include "scene/view/cascades.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/description/map_projection.hpp"

namespace tyndall::scene {
namespace {

// Returns the distance at which a ray from altitude h (elevation sine `mu`) leaves the shell below the altitude `top`.
// It is bounded, because rays to a sun below the horizon do not leave the shell upwards.
double distance_out(double h, double mu, double top, double radius_m) {
  constexpr double kLongest_m = 1.2e6;
  const double r = radius_m + h;
  const double rise = (top - h) * (2.0 * radius_m + top + h);
  if (rise <= 0.0) return 0.0;
  const double q0 = r * mu;
  const double root = std::sqrt(q0 * q0 + rise);
  const double distance = q0 >= 0.0 ? rise / (q0 + root) : root - q0;
  return std::min(distance, kLongest_m);
}

// Rounds up to a power of 2^(1/steps), so that sizes change rarely and by small steps.
double round_up(double value, double steps) {
  return std::exp2(std::ceil(std::log2(std::max(value, 1.0)) * steps - 1e-9) / steps);
}

glm::dmat3 light_frame(const glm::dvec3& to_sun) {
  glm::dvec3 x = glm::cross(glm::dvec3(0, 1, 0), to_sun);
  // A sun at the zenith has no azimuth, so any horizontal axis is suitable.
  x = glm::length(x) > 1e-6 ? glm::normalize(x) : glm::dvec3(1, 0, 0);
  const glm::dvec3 y = glm::normalize(glm::cross(to_sun, x));
  return {glm::normalize(glm::cross(y, to_sun)), y, to_sun};
}

// Returns the smallest sphere around the part of the view between the depths n and f.
void slice_sphere(const View& view, double n, double f, glm::dvec3& centre, double& radius) {
  const double k2 = view.tan_half_width * view.tan_half_width + view.tan_half_height * view.tan_half_height;
  // The centre is on the axis, at equal distances from the near and the far corners, but not beyond the far plane.
  const double c = std::min(0.5 * (n + f) * (1.0 + k2), f);
  centre = view.position + view.forward * c;
  radius = std::sqrt(std::max((f - c) * (f - c) + f * f * k2, (c - n) * (c - n) + n * n * k2));
}

struct Bounds {
  glm::dvec3 min = glm::dvec3(std::numeric_limits<double>::max());
  glm::dvec3 max = glm::dvec3(std::numeric_limits<double>::lowest());
  void add(const glm::dvec3& p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
};

// Returns the light-space bounds of the intersection of a sphere with the shell of the ground, from samples on discs at
// both altitudes, and the distance towards the sun within which there may be casters.
Bounds shell_bounds(const glm::dvec3& centre, double sphere_radius, const glm::dmat3& light_from_world,
                    const glm::dvec3& to_sun, const Ground& ground, double& caster_reach) {
  constexpr int kRings = 4;
  constexpr int kSpokes = 24;
  const glm::dvec3 zenith = up_of(centre, ground.radius_m);
  const double altitude = altitude_of(centre, ground.radius_m);
  const double gap = std::max({altitude - ground.max_m, ground.min_m - altitude, 0.0});
  const double disc = std::sqrt(std::max(sphere_radius * sphere_radius - gap * gap, 0.0));
  const glm::dvec3 east = east_of(zenith);
  const glm::dvec3 north = glm::cross(zenith, east);
  Bounds bounds;
  caster_reach = 0.0;
  for (int ring = 0; ring <= kRings; ++ring) {
    for (int spoke = 0; spoke < (ring == 0 ? 1 : kSpokes); ++spoke) {
      const double arc = disc * ring / kRings / ground.radius_m;
      const double angle = 6.283185307179586 * spoke / kSpokes;
      const glm::dvec3 up = zenith * std::cos(arc) + (east * std::cos(angle) + north * std::sin(angle)) * std::sin(arc);
      const glm::dvec3 planet(0.0, -ground.radius_m, 0.0);
      for (const double h : {ground.min_m, ground.max_m}) {
        bounds.add(light_from_world * (planet + up * (ground.radius_m + h)));
      }
      caster_reach =
          std::max(caster_reach, distance_out(ground.min_m, glm::dot(up, to_sun), ground.max_m, ground.radius_m));
    }
  }
  return bounds;
}

// Returns the fraction of a map's half extent in which it has full weight. shaders/scene/sun_shadow.glsl blends a map
// over a twentieth of its width, inside a margin for the filter and for the offset of receivers.
double full_part(const ShadowParams& shadows) { return 1.0 - 2.0 * (0.05 + 6.0 / shadows.resolution); }

// Rounds the centre and the size of a map to whole texels.
void place(CascadeFit& fit, const glm::dvec2& middle, const glm::dvec2& half_extent, const ShadowParams& shadows) {
  fit.half_extent.x = half_extent.x;
  fit.half_extent.y = half_extent.y;
  const glm::dvec2 texel = 2.0 * half_extent / static_cast<double>(shadows.resolution);
  fit.texel_m = std::max(texel.x, texel.y);
  fit.centre.x = std::round(middle.x / texel.x) * texel.x;
  fit.centre.y = std::round(middle.y / texel.y) * texel.y;
}

// Returns the cascade of the view between two depths.
CascadeFit fit_slice(const View& view, const glm::dmat3& world_from_light, double near_m, double far_m,
                     const ShadowParams& shadows, const Ground& ground) {
  CascadeFit fit;
  fit.world_from_light = world_from_light;
  fit.near_m = near_m;
  fit.far_m = far_m;
  const glm::dmat3 light_from_world = glm::transpose(world_from_light);
  glm::dvec3 sphere_centre;
  double sphere_radius = 0.0;
  slice_sphere(view, near_m, far_m, sphere_centre, sphere_radius);
  double caster_reach = 0.0;
  const Bounds bounds =
      shell_bounds(sphere_centre, sphere_radius, light_from_world, world_from_light[2], ground, caster_reach);
  // Across the light, the map covers the intersection of the bounds of shell and sphere. Sizes are rounded up, the
  // height more coarsely because it changes with the camera. Filters need a margin of a few texels.
  const glm::dvec3 sphere_light = light_from_world * sphere_centre;
  glm::dvec3 low = glm::max(bounds.min, sphere_light - sphere_radius);
  glm::dvec3 high = glm::max(glm::min(bounds.max, sphere_light + sphere_radius), low);
  double margin = 1.0 + 8.0 / shadows.resolution;
  if (!ground.casters.empty()) {
    Bounds casters;
    for (const glm::dvec3& p : ground.casters) casters.add(light_from_world * p);
    low = glm::clamp(casters.min, low, high);
    high = glm::clamp(casters.max, low, high);
    margin = 1.0 / full_part(shadows);  // the map has full weight at all casters
  }
  const glm::dvec3 half = 0.5 * (high - low);
  place(fit, 0.5 * (high + low),
        {round_up(std::max(half.x, 1.0) * margin, 8.0), round_up(std::max(half.y, 1.0) * margin, 4.0)}, shadows);
  const double slack = 0.01 * (bounds.max.z - bounds.min.z) + 10.0;
  const double z_min = bounds.min.z - slack;
  const double z_max = bounds.max.z + caster_reach + slack;
  fit.centre.z = 0.5 * (z_max + z_min);
  fit.half_extent.z = 0.5 * (z_max - z_min);
  return fit;
}

// Returns the cascade of a whole room. It has full weight everywhere in the room, for every view.
CascadeFit fit_room(const View& view, const glm::dmat3& world_from_light, const ShadowParams& shadows,
                    const Ground& ground) {
  constexpr double kShadowLength = 16.0;  // length of the shadows behind the room, in diameters of it
  CascadeFit fit;
  fit.holds_room = true;
  fit.world_from_light = world_from_light;
  const glm::dmat3 light_from_world = glm::transpose(world_from_light);
  Bounds bounds;
  for (const glm::dvec3& p : ground.room) {
    bounds.add(light_from_world * p);
    fit.far_m = std::max(fit.far_m, glm::distance(p, view.position));
  }
  const glm::dvec3 middle = 0.5 * (bounds.max + bounds.min);
  const glm::dvec3 half = glm::max(0.5 * (bounds.max - bounds.min), glm::dvec3(0.01));
  place(fit, middle, glm::dvec2(half) / full_part(shadows), shadows);
  // Towards the sun, the map extends as far as there may be terrain.
  const glm::dvec3 up = up_of(world_from_light * middle, ground.radius_m);
  const double reach = ground.casters.empty() ? distance_out(ground.min_m, glm::dot(up, world_from_light[2]),
                                                             ground.max_m, ground.radius_m)
                                              : 0.0;
  const double slack = 0.1 * glm::length(half);
  const double z_min = bounds.min.z - kShadowLength * glm::length(half) * 2.0;
  const double z_max = bounds.max.z + reach + slack;
  fit.centre.z = 0.5 * (z_max + z_min);
  fit.half_extent.z = 0.5 * (z_max - z_min);
  return fit;
}

// Replaces the first coarser cascade by the room's.
void insert_room(const View& view, const ShadowParams& shadows, const Ground& ground, std::vector<CascadeFit>& fits) {
  CascadeFit room = fit_room(view, fits[0].world_from_light, shadows, ground);
  std::size_t at = 0;
  while (at < fits.size() && fits[at].texel_m < room.texel_m) ++at;
  if (at == fits.size()) {
    if (room.far_m > 2.0 * fits.back().far_m) return;
    --at;
  }
  const double replaced_near_m = fits[at].near_m;
  if (at > 0) room.far_m = std::max(room.far_m, 1.01 * fits[at - 1].far_m);
  if (at + 1 == fits.size()) room.far_m = std::max(room.far_m, fits[at].far_m);
  fits[at] = room;
  // The next cascade also covers the part of the replaced one's range that lies outside of the room.
  for (std::size_t i = at + 1; i < fits.size(); ++i) {
    const double near_m = i == at + 1 ? replaced_near_m : fits[i].near_m > 0.0 ? fits[i - 1].far_m : 0.0;
    const double far_m = std::max(fits[i].far_m, 1.25 * fits[i - 1].far_m);
    fits[i] = fit_slice(view, room.world_from_light, std::min(near_m, fits[i].near_m), far_m, shadows, ground);
  }
}

}  // namespace

glm::dmat4 CascadeFit::shadow_from_world() const {
  const glm::dmat3 light_from_world = glm::transpose(world_from_light);
  const glm::dvec3 scale(0.5 / half_extent.x, 0.5 / half_extent.y, -0.5 / half_extent.z);
  glm::dmat4 out(1.0);
  for (int c = 0; c < 3; ++c) out[c] = glm::dvec4(light_from_world[c] * scale, 0.0);
  out[3] = glm::dvec4(glm::dvec3(0.5) - centre * scale, 1.0);
  return out;
}

glm::dmat4 clip_from_shadow() {
  glm::dmat4 out(1.0);
  out[0][0] = out[1][1] = 2.0;
  out[3] = glm::dvec4(-1.0, -1.0, 0.0, 1.0);
  return out;
}

std::vector<double> split_distances(double near_m, double far_m, std::uint32_t count, double partitioning) {
  std::vector<double> out(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double s = (i + 1.0) / count;
    const double logarithmic = near_m * std::pow(far_m / near_m, s);
    const double even = near_m + (far_m - near_m) * s;
    out[i] = partitioning * logarithmic + (1.0 - partitioning) * even;
  }
  out.back() = far_m;
  return out;
}

std::vector<CascadeFit> fit_cascades(const View& view, const glm::dvec3& direction_to_sun, const ShadowParams& shadows,
                                     const Ground& ground, double first_near_m) {
  const double altitude = altitude_of(view.position, ground.radius_m);
  // From high altitudes the ground is farther away than the requested distance.
  const double far_m = std::max(static_cast<double>(shadows.distance_m), 2.0 * (altitude - ground.min_m));
  const double near_m = std::clamp(first_near_m, kNearPlane_m, 0.5 * far_m);
  const std::vector<double> ends = split_distances(near_m, far_m, shadows.cascades, shadows.partitioning);
  const glm::dmat3 world_from_light = light_frame(direction_to_sun);

  std::vector<CascadeFit> out;
  for (std::uint32_t i = 0; i < shadows.cascades; ++i) {
    const bool at_camera = i == shadows.first_marched || i == 0;
    const double start = at_camera ? 0.0 : ends[i - 1];
    out.push_back(fit_slice(view, world_from_light, start, ends[i], shadows, ground));
  }
  if (!ground.room.empty()) insert_room(view, shadows, ground, out);
  return out;
}

std::uint32_t first_marched(const ShadowParams& shadows, std::span<const CascadeFit> cascades) {
  for (std::uint32_t i = 0; i < std::min<std::size_t>(shadows.first_marched, cascades.size()); ++i) {
    if (cascades[i].holds_room) return i;
  }
  return shadows.first_marched;
}

}  // namespace tyndall::scene
