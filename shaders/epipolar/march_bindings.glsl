// The bindings of the passes that march, with the functions that need them.
#ifndef TYNDALL_MARCH_BINDINGS_GLSL
#define TYNDALL_MARCH_BINDINGS_GLSL

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer frame_block { FrameConstants frame; };
layout(std430, binding = 2) readonly buffer epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 3) readonly buffer row_block { ShadowRow rows[]; };
layout(std430, binding = 4) readonly buffer tree_block { uint tree[]; };
layout(binding = 5) uniform sampler2DArrayShadow shadow_maps;
layout(binding = 6) uniform sampler3D single_rayleigh;
layout(binding = 7) uniform sampler3D single_mie;
layout(binding = 8) uniform sampler3D high_orders;
layout(std430, binding = 9) buffer counter_block { uint counters[]; };

#include "epipolar/ray_end.glsl"
#include "epipolar/march.glsl"

#endif
