// The constants of O'Neil's model besides the Medium. make_oneil() (src/models/oneil.hpp) computes them. Compiled as
// GLSL (std430) and as C++, like shared/medium.h. The functions are in shaders/lib/oneil.glsl.
#ifndef TYNDALL_SHARED_ONEIL
#define TYNDALL_SHARED_ONEIL

// The scale function of one species, see oneil_scale(). The published one has bend = 0 and O'Neil's five coefficients.
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
  uint integral_method;  // source of density integrals: kOneilComputed, kOneilPublished or kOneilTable
                         // (shaders/lib/oneil.glsl)
  uint samples;          // sample points of the in-scattering integral per ray
  uint spacing;          // spacing of the sample points: kOneilUniform or kOneilByDensity
  uint table_size;       // entries along each side of the table
  uint rayleigh_phase;   // 0: Rayleigh scattering is isotropic, as in O'Neil's demo
  uint unused_0;
  uint unused_1;
  uint unused_2;
  OneilScale rayleigh;
  OneilScale mie;
};

#endif
