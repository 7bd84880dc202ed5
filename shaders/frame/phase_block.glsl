// Declares the medium with the table of its phase function, for shaders that have one pipeline for all phase functions.
// To be included first.
#ifndef TYNDALL_FRAME_PHASE_BLOCK
#define TYNDALL_FRAME_PHASE_BLOCK

#include "shared/medium.h"
#include "shared/params.glsl"

layout(std430, binding = 0) readonly buffer medium_block {
  Medium medium;
  PHASE_TABLE_MEMBERS
};
#define PHASE_ENTRY(m, i) phase_table[i]
#define PHASE_TABULATED(m) ((m).mie_phase >= MiePhase_draine)

#include "lib/phase.glsl"

#endif
