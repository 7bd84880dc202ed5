// The medium of Hoffman and Preetham's model (2002): air and haze of constant density, each with the optical length of
// the real layer. Compiled as GLSL (std430) and as C++ in float and double, like shared/medium.h.
#ifndef TYNDALL_SHARED_HOMOGENEOUS
#define TYNDALL_SHARED_HOMOGENEOUS

struct Homogeneous {
  vec3 air_scattering;  // 1/m; air does not absorb
  float air_length_m;   // vertical optical length from the ground
  vec3 haze_scattering;
  float haze_length_m;
  vec3 haze_extinction;  // scattering + absorption
  float haze_g;          // positive scatters forward
  float planet_radius_m;
  float atmosphere_height_m;  // an eye above this altitude is in space
  float sun_radius_rad;       // 0: the sun sets instantly
  uint falloff;               // 1: the density falls with altitude
};

#endif
