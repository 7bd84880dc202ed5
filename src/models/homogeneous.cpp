#include "models/homogeneous.hpp"

#include <cmath>

#include "effect/medium.hpp"
#include "models/glsl_double.hpp"
#include "models/hemisphere.hpp"

namespace tyndall::models {
namespace {

constexpr int kZenithPanels = 12;  // panels of two Gauss nodes: an error of 0.1 %, see the tests
constexpr int kAzimuths = 32;

glsl64::Homogeneous widen(const shared::Homogeneous& m) {
  const auto wide = [](const Vec3& v) { return glsl64::vec3(v.x, v.y, v.z); };
  glsl64::Homogeneous out = {};
  out.air_scattering = wide(m.air_scattering);
  out.air_length_m = m.air_length_m;
  out.haze_scattering = wide(m.haze_scattering);
  out.haze_length_m = m.haze_length_m;
  out.haze_extinction = wide(m.haze_extinction);
  out.haze_g = m.haze_g;
  out.planet_radius_m = m.planet_radius_m;
  out.atmosphere_height_m = m.atmosphere_height_m;
  out.sun_radius_rad = m.sun_radius_rad;
  out.falloff = m.falloff;
  return out;
}

}  // namespace

shared::Homogeneous homogeneous_from_params(const Params& params, const HomogeneousLengths& lengths) {
  const shared::Medium medium = medium_from_params(params);
  shared::Homogeneous out = {};
  out.air_scattering = medium.rayleigh_scattering;
  out.air_length_m = static_cast<float>(lengths.air_m);
  out.haze_scattering = medium.mie_scattering;
  out.haze_length_m = static_cast<float>(lengths.haze_m);
  out.haze_extinction = medium.mie_extinction;
  out.haze_g = medium.mie_g;
  out.planet_radius_m = medium.planet_radius_m;
  out.atmosphere_height_m = medium.atmosphere_height_m;
  out.falloff = lengths.falloff ? 1 : 0;
  return out;
}

Answer homogeneous_light(const shared::Homogeneous& medium, const Ray& ray) {
  const glsl64::Homogeneous m = widen(medium);
  const glsl64::HomogeneousPath path =
      glsl64::homogeneous_path(m, ray.altitude_m, ray.cos_view_zenith, ray.cos_sun_zenith, ray.cos_view_sun, -1.0);
  glsl64::vec3 extinction;
  const glsl64::vec3 radiance = glsl64::homogeneous_inscattering(m, path, ray.cos_view_sun, extinction);
  return {glsl64::to_array(radiance * glsl64::homogeneous_sun(m, path.mu_s)), glsl64::to_array(extinction)};
}

std::array<double, 3> homogeneous_sky_irradiance(const shared::Homogeneous& medium, double altitude_m,
                                                 double cos_sun_zenith) {
  const glsl64::Homogeneous m = widen(medium);
  const bool in_space = altitude_m > m.atmosphere_height_m;
  if (in_space || glsl64::homogeneous_sun(m, cos_sun_zenith) == glsl64::vec3(0.0)) return {};
  return hemisphere_irradiance(cos_sun_zenith, kZenithPanels, kAzimuths, [&](double mu, double nu) {
    return homogeneous_light(medium, {altitude_m, mu, cos_sun_zenith, nu}).radiance;
  });
}

std::array<double, 3> homogeneous_sun(const shared::Homogeneous& medium, double altitude_m, double cos_sun_zenith) {
  const glsl64::Homogeneous m = widen(medium);
  if (altitude_m <= m.atmosphere_height_m) {
    const glsl64::vec3 at_ground = glsl64::homogeneous_sun(m, cos_sun_zenith);
    // At the ground, falloff changes nothing, and a part of the sun's disc may be visible below the horizontal.
    if (m.falloff == 0U || altitude_m <= 0.0 || cos_sun_zenith < 0.0) return glsl64::to_array(at_ground);
  } else if (glsl64::sun_visibility(altitude_m, cos_sun_zenith, m.planet_radius_m) == 0.0) {
    return {};
  }
  return homogeneous_light(medium, {altitude_m, cos_sun_zenith, cos_sun_zenith, 1.0}).transmittance;
}

}  // namespace tyndall::models
