// The aerosol's phase functions that have no formula in the shaders: the fit for water droplets, and tables. Pure
// functions, which the effect and the path tracer share: they define what the parameters mean (docs/phase.md).
#pragma once

#include "tyndall/params.hpp"

namespace tyndall::air {

// Returns whether shaders evaluate the aerosol's phase function by a table of its values.
[[nodiscard]] inline bool tabulated(const AtmosphereParams& air) {
  return air.mie_phase == MiePhase::draine || air.mie_phase == MiePhase::table;
}

// A mixture of the phase functions of Henyey and Greenstein (1941) and of Draine, "Scattering by interstellar dust
// grains" (2003), equation 4, which has the weight `weight`.
struct DropletPhase {
  double g_henyey_greenstein = 0.0;
  double g_draine = 0.0;
  double alpha = 0.0;
  double weight = 0.0;

  // Returns the phase function [1/sr], normalised to 1 over the sphere.
  [[nodiscard]] double operator()(double cosine) const;
};

// Returns the fit of the mixture to droplets of water with a median diameter in micrometres: Jendersie and d'Eon, "An
// Approximate Mie Scattering Function for Fog and Cloud Rendering" (2023), equations 4 to 7 and the supplement for
// diameters below 5 um. Precondition: 0 < diameter_um <= 50.
[[nodiscard]] DropletPhase droplet_phase(double diameter_um);

// Return the phase function [1/sr], and its mean cosine. Preconditions: tabulated(), and a table for MiePhase::table.
[[nodiscard]] double phase(const Params& params, double cosine, double wavelength_nm);
[[nodiscard]] double asymmetry(const Params& params, double wavelength_nm);

// Returns the wavelength of a channel [nm] with scattering.color = rgb.
[[nodiscard]] double channel_wavelength_nm(const Params& params, std::size_t channel);

}  // namespace tyndall::air
