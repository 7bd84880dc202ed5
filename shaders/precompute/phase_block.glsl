// Declares the medium with the table of its phase function, for passes that evaluate it. To be included first.
#ifndef TYNDALL_PRECOMPUTE_PHASE_BLOCK
#define TYNDALL_PRECOMPUTE_PHASE_BLOCK

#include "shared/medium.h"

layout(std430, binding = 0) readonly buffer medium_block {
  Medium medium;
  PHASE_TABLE_MEMBERS
};
#define PHASE_ENTRY(m, i) phase_table[i]

#include "lib/phase.glsl"

#endif
