// Densities, extinction and transmittance of the participating medium. A density integral is the integral of the three
// relative densities (x: Rayleigh, y: aerosol, z: ozone) along a path [m].
#ifndef TYNDALL_LIB_MEDIUM
#define TYNDALL_LIB_MEDIUM

#include "lib/portable.glsl"
#include "lib/spectrum.glsl"
#include "shared/medium.h"

// Returns the densities at altitude h, relative to sea level (ozone: to the peak of its tent-shaped layer). They are
// zero above the top of the atmosphere.
vec3 densities(IN(Medium) m, float h) {
  if (h > m.atmosphere_height_m) {
    return vec3(0.0);
  }
  float ozone = max(0.0, 1.0 - abs(h - m.ozone_centre_m) / m.ozone_half_width_m);
  return vec3(exp(min(-h / m.rayleigh_scale_height_m, 60.0)), exp(min(-h / m.mie_scale_height_m, 60.0)), ozone);
}

// Returns the mean densities between two points with the densities a and b. `climb` is their difference in altitude
// [m]. Exact for exponential profiles where altitude is linear between the points.
vec3 mean_densities(IN(Medium) m, vec3 a, vec3 b, float climb) {
  float rayleigh = climb / m.rayleigh_scale_height_m;
  float mie = climb / m.mie_scale_height_m;
  vec3 mean = 0.5 * (a + b);
  // On a nearly level path a - b would cancel; the arithmetic mean is then accurate to 1e-5.
  if (abs(rayleigh) > 0.01) {
    mean.x = (a.x - b.x) / rayleigh;
  }
  if (abs(mie) > 0.01) {
    mean.y = (a.y - b.y) / mie;
  }
  return mean;
}

// Returns the optical depth per channel for a density integral.
Spectrum optical_depth(IN(Medium) m, vec3 integral) {
  return RAYLEIGH_SCATTERING(m) * integral.x + MIE_EXTINCTION(m) * integral.y + OZONE_ABSORPTION(m) * integral.z;
}

// Returns the extinction coefficient at altitude h [1/m].
Spectrum extinction_at(IN(Medium) m, float h) { return optical_depth(m, densities(m, h)); }

Spectrum transmittance(IN(Medium) m, vec3 integral) { return exp(-optical_depth(m, integral)); }

#endif
