// The medium at the wavelengths of scattering.color = spectral, and the colours of light at them (docs/spectral.md).
#pragma once

#include <array>

#include "effect/shared.hpp"
#include "tyndall/params.hpp"

namespace tyndall {

using FourChannels = std::array<double, 4>;  // at the wavelengths of shaders/shared/wavelengths.h, in decreasing order

// Returns the properties of planet and atmosphere for the shaders: with scattering.color = rgb those of
// medium_from_params(), with spectral those at the four wavelengths. Precondition: as of medium_from_params().
[[nodiscard]] shared::SpectralMedium spectral_medium_from_params(const Params& params);

// Returns the linear Rec. 709 colour of light that is given relative to the sun's irradiance above the atmosphere. That
// sunlight itself has the luminance 1.
[[nodiscard]] std::array<double, 3> color_of_light(const FourChannels& light);
// Returns CIE XYZ (1931, 2 degrees) of a linear Rec. 709 colour, in the same unit.
[[nodiscard]] std::array<double, 3> xyz_of_color(const std::array<double, 3>& color);
[[nodiscard]] FourChannels spectral_wavelengths_nm();
// Returns the illuminance of the sun above the atmosphere, on a surface that faces it, over 683 lm/W [W/m^2].
[[nodiscard]] double sun_luminous_irradiance();

}  // namespace tyndall
