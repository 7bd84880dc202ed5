// Declares the constants of a frame, `medium` and `frame`. By default a shader reads them from storage buffers. Other
// ways are faster for some shaders on CPU devices (docs/epipolar.md). A shader selects them with macros, which it
// defines before its first include:
//   COPY_CONSTANTS     load_medium() and load_frame() copy them into variables; main() calls these functions first
//   UNIFORM_CONSTANTS  `frame` is a uniform block
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
