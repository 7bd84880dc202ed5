// Optical cross-sections of the Earth's air, from the literature. Wavelengths are in nm, in vacuum or in air: the
// difference of 0.03 % does not matter here.
#pragma once

namespace tyndall::air {

// A range of wavelengths [nm].
struct Range {
  double from, to;
};

constexpr Range kRayleighRange = {230.0, 1690.0};  // of Peck and Reeder's dispersion formula
constexpr Range kOzoneRange = {360.0, 840.0};      // of the table

// Returns the Rayleigh scattering cross-section of a molecule of dry air with 360 ppm of CO2 [m^2]: Bodhaine et al.,
// "On Rayleigh Optical Depth Calculations" (1999), equations 4 to 6 and 18 to 23. Precondition: within kRayleighRange.
[[nodiscard]] double rayleigh_cross_section_m2(double wavelength_nm);

// Returns the number of molecules of dry air above a square metre at a pressure [hPa], under the Earth's standard
// gravity.
[[nodiscard]] double molecules_per_m2(double pressure_hpa);

// Returns the absorption cross-section of ozone at 233 K [m^2], linear between means over 10 nm: Serdyuchenko et al.,
// "High spectral resolution ozone absorption cross-sections - Part 2" (2014). Precondition: within kOzoneRange.
[[nodiscard]] double ozone_cross_section_m2(double wavelength_nm);

constexpr double kMoleculesPerDobsonUnit =
    2.6867e20;  // molecules per m^2: a layer of 10 um at 0 degrees C and 1013.25 hPa

}  // namespace tyndall::air
