// Phase functions [1/sr], each normalised to 1 over the sphere. nu is the cosine of the angle between the view
// direction (away from the camera) and the direction to the sun: +1 means looking at the sun. Positive g scatters
// forward.
#ifndef TYNDALL_LIB_PHASE
#define TYNDALL_LIB_PHASE

#include "lib/portable.glsl"
#include "lib/spectrum.glsl"
#include "shared/medium.h"

// Code that supports phase functions without a formula defines PHASE_ENTRY(m, i), row i of the table behind the medium
// m, before it includes this file. It may define PHASE_TABULATED(m), whether to use the table; otherwise, a
// specialisation constant decides.
#ifdef PHASE_ENTRY
#ifndef PHASE_TABULATED
#include "shared/constant_ids.h"
layout(constant_id = kPhaseTableId) const bool kPhaseTable = false;
#define PHASE_TABULATED(m) kPhaseTable
#endif
#endif

// Returns the Rayleigh phase function without depolarisation, 3 / (16 pi) (1 + nu^2).
float rayleigh_phase(float nu) { return 0.0596831036594608 * (1.0 + nu * nu); }

// Returns 1 + g^2 - 2 g nu without cancellation where the result is small.
float henyey_greenstein_base(float nu, float g) {
  return g >= 0.0 ? (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - nu) : (1.0 + g) * (1.0 + g) - 2.0 * g * (1.0 + nu);
}

// Returns the phase function of Henyey and Greenstein, "Diffuse radiation in the galaxy" (1941).
float henyey_greenstein_phase(float nu, float g) {
  float base = henyey_greenstein_base(nu, g);
  return 0.0795774715459477 * (1.0 - g * g) / (base * sqrt(base));
}

// Returns the phase function of Cornette and Shanks, "Physically reasonable analytic expression for the
// single-scattering phase function" (1992), equation 8.
float cornette_shanks_phase(float nu, float g) {
  float base = henyey_greenstein_base(nu, g);
  return 0.119366207318922 * (1.0 - g * g) * (1.0 + nu * nu) / ((2.0 + g * g) * base * sqrt(base));
}

// Returns the aerosol phase function that the medium selects, if it has a formula.
float mie_phase(IN(Medium) m, float nu) {
  return m.mie_phase == 0u ? cornette_shanks_phase(nu, m.mie_g) : henyey_greenstein_phase(nu, m.mie_g);
}

// Returns the place of an angle in the table of the phase function, from 0 ahead (nu = 1) to 1: the square root of the
// sine of the half angle up to a right angle, and then the cosine of the half angle. Exact near both ends.
float phase_coordinate(float nu) {
  return nu >= 0.0 ? 0.5 * sqrt(sqrt(max(1.0 - nu, 0.0))) : 1.0 - 0.5 * sqrt(max(1.0 + nu, 0.0));
}

#ifdef PHASE_ENTRY
// Returns the phase function from the table in each channel: between the nodes, its logarithm is linear.
vec4 tabulated_phase(IN(Medium) m, float nu) {
  float x = phase_coordinate(nu) * float(kPhaseNodes - 1u);
  float low = clamp(floor(x), 0.0, float(kPhaseNodes - 2u));
  vec4 a = PHASE_ENTRY(m, uint(low));
  vec4 b = PHASE_ENTRY(m, uint(low) + 1u);
  return exp(a + (b - a) * (x - low));
}
#endif

// Returns the aerosol's scattering coefficient at sea level times its phase function [1 / (m sr)].
Spectrum mie_scattering_towards(IN(Medium) m, float nu) {
#ifdef PHASE_ENTRY
  if (PHASE_TABULATED(m)) {
#ifdef SPECTRAL
    return MIE_SCATTERING(m) * tabulated_phase(m, nu);
#else
    vec4 p = tabulated_phase(m, nu);
    return MIE_SCATTERING(m) * vec3(p.x, p.y, p.z);
#endif
  }
#endif
  return MIE_SCATTERING(m) * mie_phase(m, nu);
}

#endif
