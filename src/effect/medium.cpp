#include "effect/medium.hpp"

#include <cmath>
#include <numbers>

namespace tyndall {
namespace {

constexpr double kRefractiveIndex = 1.0003;
constexpr double kMoleculesPerM3 = 2.545e25;
constexpr double kDepolarisation = 0.035;
constexpr double kAerosolScatteringPerM = 2.0e-5;  // at aerosol_density 1, the same at every wavelength

Vec3 scaled(const Vec3& v, double factor) {
  return {static_cast<float>(v.x * factor), static_cast<float>(v.y * factor), static_cast<float>(v.z * factor)};
}

}  // namespace

double rayleigh_scattering_per_m(double wavelength_nm) {
  const double n2 = kRefractiveIndex * kRefractiveIndex - 1.0;
  const double king = (6.0 + 3.0 * kDepolarisation) / (6.0 - 7.0 * kDepolarisation);
  const double wavelength_m = wavelength_nm * 1.0e-9;
  const double pi3 = std::numbers::pi * std::numbers::pi * std::numbers::pi;
  return 8.0 * pi3 * n2 * n2 / (3.0 * kMoleculesPerM3) * king / std::pow(wavelength_m, 4);
}

shared::Medium medium_from_params(const Params& params) {
  const AtmosphereParams& air = params.atmosphere;
  shared::Medium medium = {};
  medium.planet_radius_m = params.planet.radius_m;
  medium.ground_albedo = params.planet.ground_albedo;
  medium.atmosphere_height_m = air.height_m;
  medium.rayleigh_scale_height_m = air.rayleigh_scale_height_m;
  medium.mie_scale_height_m = air.mie_scale_height_m;
  medium.mie_g = air.mie_g;
  medium.mie_phase = static_cast<std::uint32_t>(air.mie_phase);
  medium.ozone_absorption = air.ozone_absorption;
  medium.ozone_centre_m = air.ozone_centre_m;
  medium.ozone_half_width_m = air.ozone_half_width_m;

  if (air.custom_coefficients) {
    const Vec3& scattering = air.mie_scattering;
    const Vec3& absorption = air.mie_absorption;
    const Vec3 extinction = {scattering.x + absorption.x, scattering.y + absorption.y, scattering.z + absorption.z};
    medium.rayleigh_scattering = air.rayleigh_scattering;
    medium.mie_scattering = scaled(scattering, air.aerosol_density);
    medium.mie_extinction = scaled(extinction, air.aerosol_density);
  } else {
    const double aerosol = kAerosolScatteringPerM * air.aerosol_density;
    medium.rayleigh_scattering = {static_cast<float>(rayleigh_scattering_per_m(air.wavelengths_nm.x)),
                                  static_cast<float>(rayleigh_scattering_per_m(air.wavelengths_nm.y)),
                                  static_cast<float>(rayleigh_scattering_per_m(air.wavelengths_nm.z))};
    medium.mie_scattering = scaled(Vec3(1.0F), aerosol);
    medium.mie_extinction = scaled(Vec3(1.0F), aerosol * (1.0 + air.aerosol_absorption));
  }
  return medium;
}

}  // namespace tyndall
