// Computes the coefficients of the medium from the parameters, in double precision and rounded once.
#pragma once

#include "effect/shared.hpp"
#include "tyndall/params.hpp"

namespace tyndall {

// Returns the total Rayleigh scattering coefficient of air at sea level [1/m] at a wavelength [nm], for a refractive
// index of 1.0003, 2.545e25 molecules per m^3 and a depolarisation of 0.035 (Penndorf, 1957; Preetham, Shirley, Smits,
// "A Practical Analytic Model for Daylight", 1999, appendix A.3).
[[nodiscard]] double rayleigh_scattering_per_m(double wavelength_nm);

// Returns the properties of planet and atmosphere for the shaders. Precondition: the parameters are within the ranges
// of params.def. With custom_coefficients, the given coefficients are used, and aerosol_density scales those of the
// aerosol. Without, Rayleigh scattering follows from the wavelengths, aerosol scattering is 2e-5 1/m times
// aerosol_density, and aerosol absorption is aerosol_absorption times that. The coefficients of ozone are always used
// as given.
[[nodiscard]] shared::Medium medium_from_params(const Params& params);

}  // namespace tyndall
