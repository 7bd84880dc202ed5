// Declares the constants of a frame, `medium` and `frame`. Every pass of a frame is compiled twice. The variant for
// GPUs, with the macro TARGET_GPU, reads all constants from uniform blocks. The variant for CPU devices reads them from
// storage buffers by default. Other ways are faster for some passes on such devices (docs/epipolar.md). A pass selects
// them with macros, which it defines before its first include:
//   COPY_CONSTANTS     load_medium() and load_frame() copy them into variables; main() calls these functions first
//   UNIFORM_CONSTANTS  `frame` is a uniform block
#ifndef TYNDALL_CONSTANTS_GLSL
#define TYNDALL_CONSTANTS_GLSL

#include "shared/medium.h"
#include "shared/frame_constants.h"

#ifdef TYNDALL_LIB_PHASE
#error "include frame/constants.glsl before lib/phase.glsl, which uses its table of the phase function"
#endif
#define PHASE_ENTRY(m, i) phase_table[i]

#ifdef TARGET_GPU
layout(std140, binding = 0) uniform medium_block {
  Medium medium;
  PHASE_TABLE_MEMBERS
};
#elif defined(COPY_CONSTANTS)
layout(std430, binding = 0) readonly buffer medium_block {
  Medium stored_medium;
  PHASE_TABLE_MEMBERS
};
Medium medium;
#else
layout(std430, binding = 0) readonly buffer medium_block {
  Medium medium;
  PHASE_TABLE_MEMBERS
};
#endif

#if defined(TARGET_GPU) || defined(UNIFORM_CONSTANTS)
layout(std140, binding = 1) uniform frame_block { FrameConstants frame; };
#elif defined(COPY_CONSTANTS)
layout(std430, binding = 1) readonly buffer frame_block { FrameConstants stored_frame; };
FrameConstants frame;
#else
layout(std430, binding = 1) readonly buffer frame_block { FrameConstants frame; };
#endif

#ifdef TARGET_GPU
void load_medium() {}
void load_frame() {}
#elif defined(COPY_CONSTANTS)
void load_medium() { medium = stored_medium; }
#ifndef UNIFORM_CONSTANTS
void load_frame() { frame = stored_frame; }
#endif
#endif

#endif
