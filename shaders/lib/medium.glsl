// Densities, extinction and transmittance of the medium. A column is the integral of the three relative
// densities (x: Rayleigh, y: aerosol, z: ozone) along a path [m].
#ifndef TYNDALL_LIB_MEDIUM
#define TYNDALL_LIB_MEDIUM

#include "lib/portable.glsl"
#include "shared/medium.h"

// Densities relative to sea level (ozone: to the peak of its tent-shaped layer); zero above the top.
vec3 densities(IN(Medium) m, float h) {
  if (h > m.atmosphere_height_m) {
    return vec3(0.0);
  }
  float ozone = max(0.0, 1.0 - abs(h - m.ozone_centre_m) / m.ozone_half_width_m);
  return vec3(exp(min(-h / m.rayleigh_scale_height_m, 60.0)), exp(min(-h / m.mie_scale_height_m, 60.0)), ozone);
}

// Mean densities between two points, from those at both: exponential profiles exactly, where altitude is linear
// between them; `climb` is their difference in altitude [m].
vec3 mean_densities(IN(Medium) m, vec3 a, vec3 b, float climb) {
  float rayleigh = climb / m.rayleigh_scale_height_m;
  float mie = climb / m.mie_scale_height_m;
  vec3 mean = 0.5 * (a + b);
  // Level: the difference of nearly equal numbers would lose its digits, and the mean is good to 1e-5.
  if (abs(rayleigh) > 0.01) {
    mean.x = (a.x - b.x) / rayleigh;
  }
  if (abs(mie) > 0.01) {
    mean.y = (a.y - b.y) / mie;
  }
  return mean;
}

// Optical depth of a column, per channel.
vec3 optical_depth(IN(Medium) m, vec3 column) {
  return m.rayleigh_scattering * column.x + m.mie_extinction * column.y + m.ozone_absorption * column.z;
}

// Extinction coefficient at altitude h [1/m].
vec3 extinction_at(IN(Medium) m, float h) { return optical_depth(m, densities(m, h)); }

vec3 transmittance(IN(Medium) m, vec3 column) { return exp(-optical_depth(m, column)); }

#endif
