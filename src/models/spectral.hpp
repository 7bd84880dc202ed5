// Light at the four wavelengths of scattering.color = spectral, for models with three channels: they are evaluated for
// the first three wavelengths and again for the fourth.
#pragma once

#include <type_traits>
#include <utility>

#include "effect/phase_rows.hpp"
#include "effect/spectral_medium.hpp"
#include "models/single_scattering.hpp"

namespace tyndall::models {

// Returns a medium in which all three channels have the properties of the fourth wavelength.
[[nodiscard]] inline shared::Medium medium_at_fourth(const shared::SpectralMedium& medium) {
  shared::Medium out = static_cast<const shared::Medium&>(medium);
  out.rayleigh_scattering = Vec3(medium.fourth_channel.x);
  out.mie_scattering = Vec3(medium.fourth_channel.y);
  out.mie_extinction = Vec3(medium.fourth_channel.z);
  out.ozone_absorption = Vec3(medium.fourth_channel.w);
  out.ground_albedo = Vec3(medium.fourth_ground_albedo);
  return out;
}

// Returns the rows of a phase function with the values of the fourth wavelength in all channels.
[[nodiscard]] inline PhaseRows phase_at_fourth(PhaseRows rows) {
  for (shared::vec4& row : rows) row.x = row.y = row.z = row.w;
  return rows;
}

// Evaluates `model`, a function of a shared::Medium that returns an Answer, in the channels of the parameters. The
// function may have a second argument of type bool: true for the medium of medium_at_fourth().
template <typename Model>
[[nodiscard]] Answer in_all_channels(const Params& params, const shared::SpectralMedium& medium, const Model& model) {
  const auto evaluate = [&](const shared::Medium& m, bool fourth) -> Answer {
    if constexpr (std::is_invocable_v<Model, const shared::Medium&, bool>) return model(m, fourth);
    if constexpr (!std::is_invocable_v<Model, const shared::Medium&, bool>) return model(m);
  };
  Answer out = evaluate(medium, false);
  if (params.scattering.color == ColorMode::rgb) return out;
  const Answer fourth = evaluate(medium_at_fourth(medium), true);
  out.radiance_fourth = fourth.radiance[0];
  out.transmittance_fourth = fourth.transmittance[0];
  return out;
}

[[nodiscard]] inline FourChannels radiance_of(const Answer& a) {
  return {a.radiance[0], a.radiance[1], a.radiance[2], a.radiance_fourth};
}
[[nodiscard]] inline FourChannels transmittance_of(const Answer& a) {
  return {a.transmittance[0], a.transmittance[1], a.transmittance[2], a.transmittance_fourth};
}

// Returns the colour of direct sunlight at a point, relative to its luminance above the atmosphere. The parameters have
// scattering.color = spectral.
[[nodiscard]] inline std::array<double, 3> sunlight_color(const Params& params, double altitude_m,
                                                          double cos_sun_zenith) {
  const Answer light =
      in_all_channels(params, spectral_medium_from_params(params), [&](const shared::Medium& m) -> Answer {
        return {{}, sun_transmittance(m, altitude_m, cos_sun_zenith)};
      });
  return color_of_light(transmittance_of(light));
}

}  // namespace tyndall::models
