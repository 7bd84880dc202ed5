// The constants of a frame as `medium` and `frame`. Where a shader reads them from matters on CPU devices
// (docs/epipolar.md). It chooses by macros that it defines before its first include:
//   COPY_CONSTANTS     from storage buffers, copied into variables by load_medium() and so on, which main() calls first
//   UNIFORM_CONSTANTS  `frame` from a uniform block; `medium` as without this macro
// Without them, it reads storage buffers.
#ifndef TYNDALL_CONSTANTS_GLSL
#define TYNDALL_CONSTANTS_GLSL

#include "shared/medium.h"
#include "shared/frame_constants.h"

#ifdef COPY_CONSTANTS
layout(std430, binding = 0) readonly buffer medium_block { Medium stored_medium; };
Medium medium;
#else
layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
#endif

#ifdef UNIFORM_CONSTANTS
layout(std140, binding = 1) uniform frame_block { FrameConstants frame; };
#elif defined(COPY_CONSTANTS)
layout(std430, binding = 1) readonly buffer frame_block { FrameConstants stored_frame; };
FrameConstants frame;
#else
layout(std430, binding = 1) readonly buffer frame_block { FrameConstants frame; };
#endif

#ifdef COPY_CONSTANTS
void load_medium() { medium = stored_medium; }
#ifndef UNIFORM_CONSTANTS
void load_frame() { frame = stored_frame; }
#endif
#endif

#endif
