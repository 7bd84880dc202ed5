// The participating medium with all derived coefficients, as the shaders integrate it.
// Compiled as GLSL (std430) and as C++ (src/effect/shared.hpp in float, src/models/glsl_double.hpp in double). Each
// vec3 is followed by a float, so that the layouts agree without padding.
// Lengths are in m, coefficients in 1/m at sea level (ozone: at the peak of its layer).
#ifndef TYNDALL_SHARED_MEDIUM
#define TYNDALL_SHARED_MEDIUM

// Rows of the aerosol's phase function where it has no formula: its natural logarithm [ln 1/sr], one component per
// channel, at nodes that are dense ahead and towards the sun (phase_coordinate() of lib/phase.glsl). They follow the
// medium in the same block. Together they are within the smallest limit of uniform blocks, 16 384 bytes.
const uint kPhaseNodes = 1001u;
#ifdef SPECTRAL
#define PHASE_TABLE_MEMBERS vec4 phase_table[kPhaseNodes];
#else
#define PHASE_TABLE_MEMBERS   \
  vec4 unused_fourth_channel; \
  vec4 phase_table[kPhaseNodes];
#endif

struct Medium {
  vec3 rayleigh_scattering;
  float planet_radius_m;
  vec3 mie_scattering;
  float atmosphere_height_m;
  vec3 mie_extinction;  // scattering + absorption
  float rayleigh_scale_height_m;
  vec3 ozone_absorption;
  float mie_scale_height_m;
  float mie_g;
  float ozone_centre_m;
  float ozone_half_width_m;
  uint mie_phase;  // a MiePhase of include/tyndall/params.def
  vec3 ground_albedo;
  float fourth_ground_albedo;  // of scattering.color = spectral; otherwise 0
#ifdef SPECTRAL
  // Values at the fourth wavelength of scattering.color = spectral: Rayleigh scattering, aerosol scattering, aerosol
  // extinction and ozone absorption.
  vec4 fourth_channel;
#endif
#ifdef PHASE_ROWS_OF_MEDIUM
  PHASE_ROWS_OF_MEDIUM  // of C++ models
#endif
};

#endif
