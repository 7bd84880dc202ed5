// Counters of the work of a frame's passes, for `bench`. Each is a 64-bit number in two words, low word first. The
// counters cost nothing unless EffectDesc::counters is set.
#ifndef TYNDALL_COUNTERS_GLSL
#define TYNDALL_COUNTERS_GLSL

#include "shared/constant_ids.h"
#include "shared/counters.h"

layout(constant_id = kCountId) const bool kCount = false;
layout(std430, binding = 9) buffer counters_block { uint counters[]; };

void count(uint which, uint n) {
  if (!kCount) return;
  uint before = atomicAdd(counters[2u * which], n);
  if (before + n < before) atomicAdd(counters[2u * which + 1u], 1u);
}

#endif
