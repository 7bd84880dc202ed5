// The coefficients of the atmosphere that the parameters describe, at any wavelength: from scattering coefficients, or
// from what people measure (optical depth, visibility, ozone column, pressure). Pure functions, which the effect and
// the path tracer share: they define what the parameters mean. docs/air.md explains how the parameters combine.
#pragma once

#include <array>
#include <cstddef>

#include "tyndall/params.hpp"

namespace tyndall::air {

// Coefficients at sea level [1/m]; of ozone: at the peak of its layer.
struct Coefficients {
  double rayleigh_scattering = 0.0;
  double mie_scattering = 0.0;
  double mie_extinction = 0.0;  // scattering + absorption
  double ozone_absorption = 0.0;
  double ground_albedo = 0.0;  // 1
};

constexpr double kAerosolWavelength_nm = 550.0;  // of optical depth and visibility
constexpr double kKoschmieder = 3.912;           // -ln 0.02: optical depth at which a contrast falls to 2 %

// Returns the total Rayleigh scattering coefficient of air at sea level [1/m] where no pressure is given, for a
// refractive index of 1.0003, 2.545e25 molecules per m^3 and a depolarisation of 0.035 (Penndorf, 1957; Preetham,
// Shirley, Smits, "A Practical Analytic Model for Daylight", 1999, appendix A.3).
[[nodiscard]] double rayleigh_scattering_per_m(double wavelength_nm);

// Return the coefficients in one of the three channels (0 to 2), and at any wavelength. At the wavelength of a channel,
// both are equal. Between the channels, coefficients that are given for three channels follow a power of the
// wavelength, and albedos are interpolated linearly. The absorption coefficient of ozone follows its cross-sections
// between 360 and 840 nm. Beyond the channels, coefficients continue with the same power, within limits, and albedos
// are constant. Precondition: check() accepts the parameters, and the wavelength is within the ranges of
// cross_sections.hpp if they are used.
[[nodiscard]] Coefficients in_channel(const Params& params, std::size_t channel);
[[nodiscard]] Coefficients at_wavelength(const Params& params, double wavelength_nm);

// Returns parameters whose three channels are at other wavelengths, with the coefficients of at_wavelength(): a
// spectrum is evaluated in groups of three. An error names a wavelength for which a coefficient has no data.
[[nodiscard]] Result<Params> with_wavelengths(const Params& params, const std::array<double, 3>& wavelengths_nm);

// Return the integrals over the altitude, from sea level to the top of the atmosphere, of an exponential profile
// with the given scale height and of the ozone layer [m].
[[nodiscard]] double exponential_column_m(const Params& params, double scale_height_m);
[[nodiscard]] double ozone_column_m(const Params& params);

// Returns an error if parameters of the atmosphere contradict each other, or need data outside the range of the
// cross-sections.
[[nodiscard]] Result<void> check(const Params& params);
// Returns an error if the coefficients at this wavelength need data outside the range of the cross-sections.
[[nodiscard]] Result<void> check_wavelength(const Params& params, double wavelength_nm);

}  // namespace tyndall::air
