#include "models/single_scattering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/glsl_double.hpp"

namespace tyndall::models {
namespace {

constexpr int kSkySteps = 8;

// Returns the number of panels of four nodes for the irradiance of the sky. Four panels, 512 rays in all, have an error
// of 0.02 % for the default medium. Peaks of the phase function that are narrower than a few degrees need more.
int sky_panels(const glsl64::Medium& m) {
  constexpr double kNarrow = 100.0;  // times the isotropic phase function; 31 with the default g
  const glsl64::vec3 ahead = glsl64::mie_scattering_towards(m, 1.0);
  const glsl64::vec3 isotropic = m.mie_scattering * (0.25 / std::numbers::pi);
  const bool narrow =
      ahead.x > kNarrow * isotropic.x || ahead.y > kNarrow * isotropic.y || ahead.z > kNarrow * isotropic.z;
  return narrow ? 12 : 4;
}

}  // namespace

Ray ray_from_query(const RayQuery& query) {
  return ray_from_angles(query.altitude_m, query.view_zenith_rad, query.sun_zenith_rad, query.azimuth_rad);
}

Ray ray_from_angles(double altitude_m, double view_zenith_rad, double sun_zenith_rad, double azimuth_rad) {
  const double cos_view_sun = std::cos(view_zenith_rad) * std::cos(sun_zenith_rad) +
                              std::sin(view_zenith_rad) * std::sin(sun_zenith_rad) * std::cos(azimuth_rad);
  return {altitude_m, std::cos(view_zenith_rad), std::cos(sun_zenith_rad), std::clamp(cos_view_sun, -1.0, 1.0)};
}

Answer single_scattering(const shared::Medium& medium, const Ray& ray, int steps) {
  glsl64::vec3 transmittance;
  const glsl64::vec3 radiance =
      glsl64::single_scattering_to_end(glsl64::widen(medium), ray.altitude_m, ray.cos_view_zenith, ray.cos_sun_zenith,
                                       ray.cos_view_sun, steps, transmittance);
  return {glsl64::to_array(radiance), glsl64::to_array(transmittance)};
}

std::array<double, 3> single_sky_irradiance(const shared::Medium& medium, double altitude_m, double cos_sun_zenith,
                                            std::span<const shared::vec4> phase_rows) {
  const glsl64::Medium m = glsl64::widen(medium, phase_rows.empty() ? nullptr : phase_rows.data());
  return glsl64::to_array(glsl64::sky_irradiance_single(m, altitude_m, cos_sun_zenith, sky_panels(m), kSkySteps));
}

std::array<double, 3> sun_transmittance(const shared::Medium& medium, double altitude_m, double cos_sun_zenith) {
  const glsl64::Medium m = glsl64::widen(medium);
  if (glsl64::sun_visibility(altitude_m, cos_sun_zenith, m.planet_radius_m) == 0.0) return {};
  return glsl64::to_array(glsl64::transmittance(m, glsl64::density_integral_to_top(m, altitude_m, cos_sun_zenith)));
}

std::array<double, 3> transmittance_along(const shared::Medium& medium, double altitude_m, double cos_zenith,
                                          double distance_m) {
  const glsl64::Medium m = glsl64::widen(medium);
  return glsl64::to_array(
      glsl64::transmittance(m, glsl64::density_integral_along(m, altitude_m, cos_zenith, distance_m)));
}

std::array<double, 3> sunlit_ground(const shared::Medium& medium, const Ray& ray) {
  const glsl64::Medium m = glsl64::widen(medium);
  double start = 0.0;
  double end = 0.0;
  bool on_ground = false;
  const bool black = m.ground_albedo == glsl64::vec3(0.0);
  if (black || !glsl64::atmosphere_segment(ray.altitude_m, ray.cos_view_zenith, m.atmosphere_height_m,
                                           m.planet_radius_m, start, end, on_ground)) {
    // A downward ray that begins on the ground has length 0 and still sees the ground.
    end = 0.0;
    on_ground = !black && glsl64::ray_hits_ground(ray.altitude_m, ray.cos_view_zenith, m.planet_radius_m);
  }
  if (!on_ground) return {};
  const double r0 = m.planet_radius_m + ray.altitude_m;
  const double ground_m = glsl64::ground_below(ray.altitude_m, m.planet_radius_m);
  const double cos_sun =
      std::clamp((r0 * ray.cos_sun_zenith + end * ray.cos_view_sun) / (m.planet_radius_m + ground_m), -1.0, 1.0);
  if (cos_sun <= 0.0) return {};
  std::array<double, 3> out = sun_transmittance(medium, ground_m, cos_sun);
  for (int c = 0; c < 3; ++c) out[static_cast<std::size_t>(c)] *= m.ground_albedo[c] * cos_sun / std::numbers::pi;
  return out;
}

shared::ProbeRay prepare_probe_ray(const shared::Medium& medium, const Ray& ray) {
  const glsl64::Medium m = glsl64::widen(medium);
  double start = 0.0;
  double end = 0.0;
  bool on_ground = false;
  shared::ProbeRay out = {};
  out.cos_view_sun = static_cast<float>(ray.cos_view_sun);
  double altitude = ray.altitude_m;
  double cos_view = ray.cos_view_zenith;
  double cos_sun = ray.cos_sun_zenith;
  if (glsl64::atmosphere_segment(altitude, cos_view, m.atmosphere_height_m, m.planet_radius_m, start, end, on_ground)) {
    if (start > 0.0) {
      const double r0 = m.planet_radius_m + altitude;
      const double r = m.planet_radius_m + m.atmosphere_height_m;
      cos_sun = std::clamp((r0 * cos_sun + start * ray.cos_view_sun) / r, -1.0, 1.0);
      cos_view = std::clamp((r0 * cos_view + start) / r, -1.0, 1.0);
      altitude = m.atmosphere_height_m;
    }
    out.end_m = static_cast<float>(end - start);
    out.on_ground = on_ground ? 1 : 0;
  } else {
    // A downward ray that begins on the ground has length 0 and still sees the ground.
    out.on_ground = glsl64::ray_hits_ground(altitude, cos_view, m.planet_radius_m) ? 1 : 0;
  }
  out.altitude_m = static_cast<float>(altitude);
  out.cos_view_zenith = static_cast<float>(cos_view);
  out.cos_sun_zenith = static_cast<float>(cos_sun);
  return out;
}

}  // namespace tyndall::models
