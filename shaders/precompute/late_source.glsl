// The late orders of scattering, those after `orders` of TableShape. By then the light has lost most of its dependence
// on azimuth, so the solution continues with the first terms of its Fourier series in azimuth. The source function, its
// sum over the late orders and the incident light store these terms in the elements of the first azimuths of their
// buffers.
#ifndef TYNDALL_LATE_SOURCE_GLSL
#define TYNDALL_LATE_SOURCE_GLSL

#include "lib/medium.glsl"
#include "precompute/gather_grid.glsl"

const uint kLateTerms = 5u;  // of the source function of order `orders`

// Number of terms of the source function of order n: one fewer with each order, but at least kLateModes.
uint late_modes(TableShape shape, uint n) {
  return max(kLateTerms + shape.orders - min(n, kLateTerms + shape.orders), kLateModes);
}

// Element of term m of the source function, per scattering coefficient. Term 0, the mean, is stored as its fourth root,
// term 1 as its ratio to the mean: both are interpolated between suns. The other terms are stored as they are.
uint late_source_index(uint altitude, uint zenith, uint m, uint sun) { return source_index(altitude, zenith, m, sun); }
// Element of term m of the sum of the source functions of the late orders.
uint late_sum_index(uint altitude, uint zenith, uint m, uint sun) {
  return source_index(altitude, zenith, kLateTerms + m, sun);
}
// Element of term m of the incident light.
uint late_incident_index(uint altitude, uint zenith, uint m, uint sun) {
  return gather_index(altitude, zenith, m, sun);
}

// Returns the part of the aerosol in the scattering coefficient at altitude h.
vec3 aerosol_part(Medium m, float h) {
  vec3 density = densities(m, h);
  vec3 mie = m.mie_scattering * density.y;
  return mie / max(m.rayleigh_scattering * density.x + mie, vec3(1.0e-30));
}

#endif
