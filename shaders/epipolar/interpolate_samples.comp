// Interpolates the mean source functions of samples that are not marched between two marched ones (Yusov 2013, section
// 1.3).
#version 460
#extension GL_GOOGLE_include_directive : require

#define COPY_CONSTANTS

#include "epipolar/constants.glsl"
#include "epipolar/records.glsl"

layout(local_size_x = 32, local_size_y = 2) in;

layout(std430, binding = 13) readonly buffer slices_block { EpipolarSlice slices[]; };
layout(std430, binding = 15) readonly buffer interpolation_sources_block { uint sources[]; };
layout(std430, binding = 14) buffer samples_block { uvec4 samples[]; };
layout(std430, binding = 16) readonly buffer coarse_inscattering_block { uint coarse[]; };

// Relative decrease of the square root of the source function per fraction of in-scattering from behind shadowed end
// points.
const float kLostInShadow = 0.35;
const float kMaxBeyond = 0.1;  // beyond samples at a different depth

void main() {
  load_epipolar();
  uint i = gl_GlobalInvocationID.x;
  uint id = gl_GlobalInvocationID.y;
  if (i >= epipolar.samples || id >= epipolar.slices || i > slices[id].last) return;
  uint row = id * epipolar.samples;
  uint left = sources[row + i] & 0xFFFFu;
  uint right = sources[row + i] >> 16u;
  if (left == right) return;
  uvec4 a = samples[row + left];
  uvec4 b = samples[row + right];
  float part = float(i - left) / float(right - left);
  // If the coarse in-scattering is not on the line between those of the interpolation sources, the ray ends in front of
  // or behind their rays. If the sources have shadowed end points, the additional part of the medium contributes only
  // higher orders, which reduces the mean source function.
  uint coarse_a = coarse[row + left];
  uint coarse_b = coarse[row + right];
  vec2 light = unpack_coarse(coarse[row + i]);
  vec2 beyond = (light - mix(unpack_coarse(coarse_a), unpack_coarse(coarse_b), part)) / max(light, vec2(1e-30));
  float dark = mix(shadowed_end(coarse_a), shadowed_end(coarse_b), part);
  float scale = 1.0 - kLostInShadow * dark * clamp(0.5 * (beyond.x + beyond.y), -kMaxBeyond, kMaxBeyond);
  // The square roots of source functions take three halves of y and z. The fourth half belongs to the extinction
  // coefficient.
  samples[row + i].y = packHalf2x16(mix(unpackHalf2x16(a.y), unpackHalf2x16(b.y), part) * scale);
  float blue = mix(unpackHalf2x16(a.z).x, unpackHalf2x16(b.z).x, part) * scale;
  samples[row + i].z = (packHalf2x16(vec2(blue, 0.0)) & 0xFFFFu) | (samples[row + i].z & 0xFFFF0000u);
#ifdef SPECTRAL
  float fourth_a = unpackHalf2x16(FOURTH_CHANNEL(row + left)).x;
  float fourth_b = unpackHalf2x16(FOURTH_CHANNEL(row + right)).x;
  float extinction = unpackHalf2x16(FOURTH_CHANNEL(row + i)).y;
  FOURTH_CHANNEL(row + i) = packHalf2x16(vec2(mix(fourth_a, fourth_b, part) * scale, extinction));
#endif
}
