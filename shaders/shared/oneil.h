// What O'Neil's model needs beside the Medium: made by make_oneil (src/models/oneil.hpp). Compiled by GLSL
// (std430) and by C++ like shared/medium.h. The functions are in shaders/lib/oneil.glsl.
#ifndef TYNDALL_SHARED_ONEIL
#define TYNDALL_SHARED_ONEIL

// The scale function of one species: see oneil_scale. Printed: bend 0 and O'Neil's five coefficients.
struct OneilScale {
  float scale_height_m;
  float bend;
  float k0;
  float k1;
  float k2;
  float k3;
  float k4;
  float unused_0;
};

struct Oneil {
  uint integral_method;  // where columns come from: a kOneil... constant of shaders/lib/oneil.glsl
  uint samples;          // points of the in-scattering integral on a ray
  uint spacing;          // of these points, likewise
  uint table_size;       // entries along each side of the table
  uint rayleigh_phase;   // 0: Rayleigh scattering is even in all directions, as in O'Neil's demo
  uint unused_0;
  uint unused_1;
  uint unused_2;
  OneilScale rayleigh;
  OneilScale mie;
};

#endif
