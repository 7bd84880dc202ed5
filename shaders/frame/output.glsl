// The picture that a frame writes. The module declares the format rgba16f; a pipeline for rgba32f changes that word
// (src/gpu/storage_format.hpp), so that one module serves both.
#ifndef TYNDALL_OUTPUT_GLSL
#define TYNDALL_OUTPUT_GLSL

#include "frame/constants.glsl"
#include "lib/half.glsl"
#include "shared/constant_ids.h"

layout(constant_id = kFloatOutputId) const bool kFloatOutput = false;
layout(binding = 5, rgba16f) uniform writeonly image2D output_color;

void store_color(ivec2 pixel, vec3 color) {
#ifdef SPECTRAL
  // Saturated light has colours outside of Rec. 709.
  color = max(color, vec3(0.0));
#endif
  const float kLargest = kFloatOutput ? 3.4e38 : kLargestHalf;
  imageStore(output_color, pixel + frame.output_offset, vec4(min(color, vec3(kLargest)), 1.0));
}

#endif
