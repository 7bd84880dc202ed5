// The medium's coefficients from the parameters: pure, computed in double precision, rounded once.
#pragma once

#include "effect/shared.hpp"
#include "tyndall/params.hpp"

namespace tyndall {

// Total Rayleigh scattering coefficient of sea-level air [1/m] at a wavelength [nm], for a refractive index
// of 1.0003, 2.545e25 molecules per m^3 and a depolarisation of 0.035 (Penndorf, 1957; Preetham, Shirley,
// Smits, "A Practical Analytic Model for Daylight", 1999, appendix A.3).
[[nodiscard]] double rayleigh_scattering_per_m(double wavelength_nm);

// Everything that the shaders need to know of planet and air. Precondition: the parameters are within the
// ranges of params.def. With custom_coefficients the given coefficients hold, and aerosol_density scales both
// aerosol ones; without, Rayleigh scattering follows from the wavelengths, aerosol scattering is 2e-5 1/m
// times aerosol_density, and aerosol absorption is aerosol_absorption times that. Ozone holds as given in
// both.
[[nodiscard]] shared::Medium medium_from_params(const Params& params);

}  // namespace tyndall
