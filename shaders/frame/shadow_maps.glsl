// The caller's shadow cascades, for comparisons.
#ifndef TYNDALL_SHADOW_MAPS_GLSL
#define TYNDALL_SHADOW_MAPS_GLSL

#include "shared/frame_constants.h"

layout(std140, binding = 11) uniform cascades_block { CascadeConstants cascades[kMaxCascades]; };
layout(binding = 12) uniform sampler2DArrayShadow shadow_maps;

#endif
