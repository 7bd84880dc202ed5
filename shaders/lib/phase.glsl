// Phase functions [1/sr], each normalised to 1 over the sphere. nu is the cosine of the angle between the view
// direction (away from the camera) and the direction to the sun: +1 means looking at the sun. Positive g scatters
// forward.
#ifndef TYNDALL_LIB_PHASE
#define TYNDALL_LIB_PHASE

#include "lib/portable.glsl"
#include "shared/medium.h"

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

// Returns the aerosol phase function that the medium selects.
float mie_phase(IN(Medium) m, float nu) {
  return m.mie_phase == 0u ? cornette_shanks_phase(nu, m.mie_g) : henyey_greenstein_phase(nu, m.mie_g);
}

#endif
