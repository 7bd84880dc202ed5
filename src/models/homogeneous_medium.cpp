#include "models/homogeneous_medium.hpp"

#include <algorithm>
#include <cmath>

#include "air/phase.hpp"
#include "effect/medium.hpp"
#include "effect/spectral_medium.hpp"
#include "models/glsl_double.hpp"
#include "models/hemisphere.hpp"

namespace tyndall::models {
namespace {

constexpr int kFineZenithPanels = 48;  // panels of two Gauss nodes
constexpr int kFineAzimuths = 64;

std::array<double, 3> times(const Vec3& v, const Vec3& by) {
  return {static_cast<double>(v.x) * static_cast<double>(by.x), static_cast<double>(v.y) * static_cast<double>(by.y),
          static_cast<double>(v.z) * static_cast<double>(by.z)};
}

// Returns the length of a ray within the medium.
double length_in(const HomogeneousMedium& m, double altitude_m, double cos_zenith) {
  double start = 0.0;
  double end = m.extent_m;
  if (glsl64::ray_hits_ground(altitude_m, cos_zenith, m.planet_radius_m)) {
    end = glsl64::distance_to_ground(altitude_m, cos_zenith, m.planet_radius_m);
  }
  // Clip to below the plane at height_m: an upward ray ends there, a downward ray from above begins there.
  const double below = m.height_m - altitude_m;
  if (cos_zenith > 0.0) end = std::min(end, below / cos_zenith);
  if (cos_zenith < 0.0) start = std::max(below / cos_zenith, 0.0);
  if (cos_zenith == 0.0 && below < 0.0) end = 0.0;
  return std::max(end - start, 0.0);
}

}  // namespace

HomogeneousMedium homogeneous_medium_from_params(const Params& params) {
  return homogeneous_medium_from_params(params, medium_from_params(params));
}

HomogeneousMedium homogeneous_medium_from_params(const Params& params, const shared::Medium& sea_level, bool fourth) {
  const HomogeneousMediumParams& p = params.homogeneous_medium;
  HomogeneousMedium out;
  out.rayleigh_scattering = times(sea_level.rayleigh_scattering, Vec3(p.density));
  out.mie_scattering = times(sea_level.mie_scattering, Vec3(p.density));
  out.extinction = times(sea_level.mie_extinction, Vec3(p.density));
  for (std::size_t c = 0; c < 3; ++c) out.extinction[c] += out.rayleigh_scattering[c];
  out.sunlight = times(p.sunlight, Vec3(1.0F));
  out.g = params.atmosphere.mie_g;
  out.cornette_shanks = params.atmosphere.mie_phase == MiePhase::cornette_shanks;
  if (air::tabulated(params.atmosphere)) {
    out.tabulated = &params;
    const FourChannels nm = spectral_wavelengths_nm();
    for (std::size_t c = 0; c < 3; ++c) {
      const bool spectral = params.scattering.color == ColorMode::spectral;
      out.wavelengths_nm[c] = spectral ? nm[fourth ? 3 : c] : air::channel_wavelength_nm(params, c);
    }
  }
  out.planet_radius_m = params.planet.radius_m;
  out.extent_m = p.extent_m;
  out.height_m = p.height_m;
  return out;
}

Answer homogeneous_medium_light(const HomogeneousMedium& m, const Ray& ray) {
  const double length = length_in(m, ray.altitude_m, ray.cos_view_zenith);
  const double rayleigh = glsl64::rayleigh_phase(ray.cos_view_sun);
  const double formula = m.cornette_shanks ? glsl64::cornette_shanks_phase(ray.cos_view_sun, m.g)
                                           : glsl64::henyey_greenstein_phase(ray.cos_view_sun, m.g);
  Answer out;
  for (std::size_t c = 0; c < 3; ++c) {
    const double tau = m.extinction[c] * length;
    const double mie =
        m.tabulated != nullptr ? air::phase(*m.tabulated, ray.cos_view_sun, m.wavelengths_nm[c]) : formula;
    // (1 - exp(-tau)) / sigma, which is the length itself without extinction.
    const double lit = m.extinction[c] > 0.0 ? -std::expm1(-tau) / m.extinction[c] : length;
    out.radiance[c] = m.sunlight[c] * (m.rayleigh_scattering[c] * rayleigh + m.mie_scattering[c] * mie) * lit;
    out.transmittance[c] = std::exp(-tau);
  }
  return out;
}

std::array<double, 3> homogeneous_medium_sky(const HomogeneousMedium& m, double altitude_m, double cos_sun_zenith) {
  return hemisphere_irradiance(cos_sun_zenith, kFineZenithPanels, kFineAzimuths, [&](double mu, double nu) {
    return homogeneous_medium_light(m, {altitude_m, mu, cos_sun_zenith, nu}).radiance;
  });
}

}  // namespace tyndall::models
