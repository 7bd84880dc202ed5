// The sources of the samples that were not marched, between those of two that were (Yusov 2013, section 1.3).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/epipolar.h"

layout(local_size_x = 32, local_size_y = 2) in;

layout(std430, binding = 0) readonly buffer epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 1) readonly buffer slice_block { EpipolarSlice slices[]; };
layout(std430, binding = 2) readonly buffer source_block { uint sources[]; };
layout(std430, binding = 3) buffer sample_block { uvec4 samples[]; };

#include "epipolar/records.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x;
  uint id = gl_GlobalInvocationID.y;
  if (i >= epipolar.samples || id >= epipolar.slices || i > slices[id].last) return;
  uint row = id * epipolar.samples;
  uint left = sources[row + i] & 0xFFFFu;
  uint right = sources[row + i] >> 16u;
  if (left == right) return;
  Sample s = unpack_sample(samples[row + i]);
  vec3 a = unpack_sample(samples[row + left]).source;
  vec3 b = unpack_sample(samples[row + right]).source;
  s.source = mix(a, b, float(i - left) / float(right - left));
  samples[row + i].yz = pack_sample(s).yz;
}
