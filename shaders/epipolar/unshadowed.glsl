// The light that a ray would have without shadows, coarsely: what a medium mixed evenly along it gives, in closed form. It follows
// every change of depth and direction, which is all that is asked of it. Include after declaring medium.
#ifndef TYNDALL_UNSHADOWED_GLSL
#define TYNDALL_UNSHADOWED_GLSL

#include "lib/phase.glsl"
#include "lib/optical_depth.glsl"
#include "lib/table_values.glsl"

vec3 unshadowed_light(float cos_view_sun, vec3 column) {
  Guide guide = guide_for_column(medium, column);
  return medium.rayleigh_scattering * rayleigh_phase(cos_view_sun) * guide.rayleigh +
         medium.mie_scattering * mie_phase(medium, cos_view_sun) * guide.mie;
}

#endif
