// Builds the luminance histogram of a picture, for the exposure and for the viewer's display. Reads one pixel of each
// stride x stride block, staggered so that every row and column is covered. Counts are integers, so the order of
// addition does not matter.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "post/tonemap_curves.glsl"
#include "shared/exposure.h"

layout(local_size_x = 16, local_size_y = 16) in;

layout(binding = 0, rgba32f) uniform readonly image2D radiance;
layout(std430, binding = 1) buffer CountsBlock { LuminanceCounts counts; }
counts_block;

layout(push_constant) uniform Push { uint stride; }
push;

shared uint bins[kLuminanceBins];
shared uint black;

const int kSamplesOnSide = 4;  // per invocation

void main() {
  uint index = gl_LocalInvocationIndex;
  bins[index] = 0u;
  if (index == 0u) black = 0u;
  barrier();
  ivec2 size = imageSize(radiance);
  int stride = int(push.stride);
  ivec2 first = ivec2(gl_WorkGroupID.xy) * (16 * kSamplesOnSide) + ivec2(gl_LocalInvocationID.xy);
  for (int i = 0; i < kSamplesOnSide * kSamplesOnSide; ++i) {
    ivec2 at = first + 16 * ivec2(i % kSamplesOnSide, i / kSamplesOnSide);
    ivec2 pixel = at * stride + at.yx % stride;
    if (pixel.x >= size.x || pixel.y >= size.y) continue;
    // tonemap_scaled() replaces NaN and infinite channels.
    float luminance = tonemap_luminance(tonemap_scaled(imageLoad(radiance, pixel).rgb, 1.0));
    float position = (log2(max(luminance, 1.0e-30)) - kLowestStop) / kStopsPerBin;
    if (position < 0.0) {
      atomicAdd(black, kSampleParts);
    } else {
      position = min(position, float(kLuminanceBins - 1u));
      uint bin = min(uint(position), kLuminanceBins - 2u);
      uint upper = uint((position - float(bin)) * float(kSampleParts) + 0.5);
      atomicAdd(bins[bin], kSampleParts - upper);
      atomicAdd(bins[bin + 1u], upper);
    }
  }
  barrier();
  if (bins[index] > 0u) atomicAdd(counts_block.counts.bins[index], bins[index]);
  if (index == 0u && black > 0u) atomicAdd(counts_block.counts.black, black);
}
