// The constants of a frame with epipolar sampling: `epipolar` besides those of frame/constants.glsl, read from the same
// kind of memory.
#ifndef TYNDALL_EPIPOLAR_CONSTANTS_GLSL
#define TYNDALL_EPIPOLAR_CONSTANTS_GLSL

#include "frame/constants.glsl"
#include "shared/epipolar.h"

#if defined(TARGET_GPU) || defined(UNIFORM_CONSTANTS)
layout(std140, binding = 2) uniform epipolar_block { EpipolarConstants epipolar; };
#elif defined(COPY_CONSTANTS)
layout(std430, binding = 2) readonly buffer epipolar_block { EpipolarConstants stored_epipolar; };
EpipolarConstants epipolar;
#else
layout(std430, binding = 2) readonly buffer epipolar_block { EpipolarConstants epipolar; };
#endif

#ifdef TARGET_GPU
void load_epipolar() {}
#elif defined(COPY_CONSTANTS) && !defined(UNIFORM_CONSTANTS)
void load_epipolar() { epipolar = stored_epipolar; }
#endif

#endif
