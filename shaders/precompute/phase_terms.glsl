// Reads the Fourier coefficients of the phase functions, phase_block { vec2 phase[]; }, which phase_matrix.comp writes.
#ifndef TYNDALL_PRECOMPUTE_PHASE_TERMS
#define TYNDALL_PRECOMPUTE_PHASE_TERMS

#include "lib/spectrum.glsl"
#include "shared/constant_ids.h"
#include "shared/tables.h"

layout(constant_id = kPhaseTableId) const bool kPhaseTable = false;

struct PhaseTerm {
  float rayleigh;
  Spectrum aerosol;
};

layout(std430, binding = 2) readonly buffer phase_block { vec2 phase[]; };

PhaseTerm phase_term(uint i) {
  if (!kPhaseTable) {
    vec2 p = phase[i];
    return PhaseTerm(p.x, Spectrum(p.y));
  }
  vec2 first = phase[kPhaseTerms * i];
  vec2 middle = phase[kPhaseTerms * i + 1u];
#ifdef SPECTRAL
  return PhaseTerm(first.x, vec4(first.y, middle, phase[kPhaseTerms * i + 2u].x));
#else
  return PhaseTerm(first.x, vec3(first.y, middle));
#endif
}

#endif
