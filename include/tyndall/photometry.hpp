// Photometric units: what a colour relative to the sun means in candela per square metre, and exposure values of
// cameras. white_luminance() converts radiance in the unit of Sun::irradiance per steradian to luminance. This is exact
// with scattering.color = spectral, and approximate with three channels, where the sun counts as white.
#pragma once

#include <cmath>

#include "tyndall/types.hpp"

namespace tyndall {

constexpr double kLuminousEfficacy = 683.0;  // lm/W at 555 nm
// [lx] - of the sun above the atmosphere at a distance of 1 au, on a surface that faces it: the extraterrestrial
// spectrum of ASTM G173-03 with the observer of CIE 1931 (docs/spectral.md).
constexpr double kSunIlluminance_lux = 133183.27;

// Returns the luminance of a linear Rec. 709 colour, in its unit.
[[nodiscard]] constexpr double luminance(const Vec3& color) {
  return 0.2126729 * static_cast<double>(color.x) + 0.7151522 * static_cast<double>(color.y) +
         0.0721750 * static_cast<double>(color.z);
}

// Returns the luminance of the colour (1, 1, 1) [cd/m^2], for a sun above the atmosphere whose irradiance has this
// colour: Sun::irradiance * scattering.scale * sun_color(). 0 if there is no sun.
[[nodiscard]] constexpr double white_luminance(const Vec3& irradiance) {
  const double sun = luminance(irradiance);
  return sun > 0.0 ? kSunIlluminance_lux / sun : 0.0;
}

// The luminance that a reflected-light meter maps to middle grey at an exposure value of 0 [cd/m^2]: the constant
// K = 12.5 over an ISO speed of 100 (ISO 2720:1974).
constexpr double kMeteredLuminance = 0.125;

// Returns the exposure value at ISO 100 of a camera: f-number, exposure time [s] and ISO speed. All are above 0.
[[nodiscard]] inline double ev100_of_camera(double aperture, double shutter_s, double iso) {
  return std::log2(aperture * aperture / shutter_s * 100.0 / iso);
}

// Returns the factor on a colour that maps the metered luminance to `middle_gray`; `white` is white_luminance().
[[nodiscard]] inline double exposure_of_ev100(double ev100, double middle_gray, double white) {
  return middle_gray * white / (kMeteredLuminance * std::exp2(ev100));
}
// Returns the exposure value at ISO 100 to which such a factor corresponds. All are above 0.
[[nodiscard]] inline double ev100_of_exposure(double exposure, double middle_gray, double white) {
  return std::log2(middle_gray * white / (kMeteredLuminance * exposure));
}

}  // namespace tyndall
