// The late orders of scattering: those after `orders` of TableShape. By then the light has lost most of its dependence
// on azimuth, so the solution continues with the first terms of its Fourier series in azimuth. The incident light
// stores these terms in the elements of the first azimuths of its buffer.
#ifndef TYNDALL_LATE_SOURCE_GLSL
#define TYNDALL_LATE_SOURCE_GLSL

#include "lib/medium.glsl"
#include "precompute/gather_grid.glsl"

// Returns the number of Fourier modes of the source function of order n. Each scattering multiplies mode m by about
// g^m, so order n with 2 kModes / n modes is truncated at the same error as order 2 with all kModes.
uint source_modes(uint n) { return clamp((2u * kModes + n - 1u) / n, kLateTerms, kModes); }

// Returns the number of terms of the source function of a late order n: one fewer with each order, but at least
// kLateModes.
uint late_modes(TableShape shape, uint n) {
  return max(kLateTerms + shape.orders - min(n, kLateTerms + shape.orders), kLateModes);
}

// Returns the index of term m of the source function, per scattering coefficient. Term 0, the mean, is stored as its
// fourth root, term 1 as its ratio to the mean: both are interpolated between suns. The other terms are stored as they
// are.
uint late_source_index(uint altitude, uint zenith, uint m, uint sun) {
  return ((altitude * kSourceZeniths + zenith) * 2u * kLateTerms + m) * kGatherSuns + sun;
}
// Returns the index of term m of the sum of the source functions of the late orders.
uint late_sum_index(uint altitude, uint zenith, uint m, uint sun) {
  return late_source_index(altitude, zenith, kLateTerms + m, sun);
}
// Returns the index of term m of the incident light.
uint late_incident_index(uint altitude, uint zenith, uint m, uint sun) {
  return gather_index(altitude, zenith, m, sun);
}

// Returns the aerosol's fraction of the scattering coefficient at altitude h.
Spectrum aerosol_part(Medium m, float h) {
  vec3 density = densities(m, h);
  Spectrum mie = MIE_SCATTERING(m) * density.y;
  return mie / max(RAYLEIGH_SCATTERING(m) * density.x + mie, Spectrum(1.0e-30));
}

#endif
