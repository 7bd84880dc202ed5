#include "effect/medium.hpp"

#include "air/coefficients.hpp"
#include "air/phase.hpp"

namespace tyndall {

shared::Medium medium_from_params(const Params& params) {
  const AtmosphereParams& a = params.atmosphere;
  shared::Medium medium = {};
  medium.planet_radius_m = params.planet.radius_m;
  medium.atmosphere_height_m = a.height_m;
  medium.rayleigh_scale_height_m = a.rayleigh_scale_height_m;
  medium.mie_scale_height_m = a.mie_scale_height_m;
  medium.mie_g = air::tabulated(a) ? static_cast<float>(air::asymmetry(params, air::kAerosolWavelength_nm)) : a.mie_g;
  medium.mie_phase = static_cast<std::uint32_t>(a.mie_phase);
  medium.ozone_centre_m = a.ozone_centre_m;
  medium.ozone_half_width_m = a.ozone_half_width_m;
  const air::Coefficients channels[] = {air::in_channel(params, 0), air::in_channel(params, 1),
                                        air::in_channel(params, 2)};
  const auto each = [&](double air::Coefficients::*value) {
    return Vec3(static_cast<float>(channels[0].*value), static_cast<float>(channels[1].*value),
                static_cast<float>(channels[2].*value));
  };
  medium.rayleigh_scattering = each(&air::Coefficients::rayleigh_scattering);
  medium.mie_scattering = each(&air::Coefficients::mie_scattering);
  medium.mie_extinction = each(&air::Coefficients::mie_extinction);
  medium.ozone_absorption = each(&air::Coefficients::ozone_absorption);
  medium.ground_albedo = each(&air::Coefficients::ground_albedo);
  return medium;
}

}  // namespace tyndall
