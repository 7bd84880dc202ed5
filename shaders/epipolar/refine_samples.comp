// Chooses the samples that are marched, and for the others the two that they are interpolated between
// (Yusov 2013, section 1.3). One group per slice: breaks between neighbours become bits, and each sample looks
// for the nearest to both sides within its segment of initial_step samples.
// sources: index of the left source, and of the right one << 16, on the same slice; equal where it is marched.
// The list of marched samples, slice << 16 | index, keeps the order of each slice.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"

const uint kThreads = 64u;

layout(local_size_x = kThreads) in;
layout(constant_id = 0) const uint kRefinement = 1u;  // 0 by depth, 1 by in-scattering

layout(std430, binding = 0) readonly buffer frame_block { FrameConstants frame; };
layout(std430, binding = 1) readonly buffer epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 2) readonly buffer slice_block { EpipolarSlice slices[]; };
layout(std430, binding = 3) readonly buffer coarse_block { vec4 coarse[]; };
layout(std430, binding = 4) writeonly buffer source_block { uint sources[]; };
layout(std430, binding = 5) buffer march_list_block { WorkList march; uint march_list[]; };

#include "epipolar/slices.glsl"
#include "epipolar/work_list.glsl"

const uint kWords = 64u;  // for 2048 samples
// Light below this part of the slice's mean makes no break: it is too dark to be seen beside the rest.
const float kDark = 0.05;

shared uint breaks[kWords];   // bit i: between samples i and i + 1
shared uint marched[kWords];
shared uint before[kWords];   // marched samples in the words before
shared vec3 partial[kThreads];
shared vec3 floor_light;
shared uint list_start;

bool is_break(uint at) {
  vec4 a = coarse[at];
  vec4 b = coarse[at + 1u];
  if (kRefinement == 0u) return abs(a.w - b.w) > 0.2 * epipolar.threshold * max(max(a.w, b.w), 1.0);
  vec3 change = abs(a.rgb - b.rgb) / max(max(a.rgb, b.rgb), floor_light);
  return max(change.r, max(change.g, change.b)) > epipolar.threshold;
}

uint bits_from(uint first) { return 0xFFFFFFFFu << (first & 31u); }
uint bits_to(uint last) { return 0xFFFFFFFFu >> (31u - (last & 31u)); }

// The sample after the last break in [from, at - 1], or from.
uint left_source(uint from, uint at) {
  for (uint i = at; i > from;) {
    uint word = (i - 1u) >> 5u;
    uint bits = breaks[word] & bits_to(i - 1u);
    if (word == from >> 5u) bits &= bits_from(from);
    if (bits != 0u) return word * 32u + uint(findMSB(bits)) + 1u;
    i = min(word * 32u, i - 1u);
  }
  return from;
}

// The first break in [at, to - 1], or to.
uint right_source(uint at, uint to) {
  for (uint i = at; i < to;) {
    uint word = i >> 5u;
    uint bits = breaks[word] & bits_from(i);
    if (word == (to - 1u) >> 5u) bits &= bits_to(to - 1u);
    if (bits != 0u) return word * 32u + uint(findLSB(bits));
    i = (word + 1u) * 32u;
  }
  return to;
}

void main() {
  uint id = gl_WorkGroupID.x;
  uint thread = gl_LocalInvocationID.x;
  EpipolarSlice slice = slices[id];
  uint row = id * epipolar.samples;
  if (thread < kWords) {
    breaks[thread] = 0u;
    marched[thread] = 0u;
  }
  vec3 sum = vec3(0.0);
  for (uint i = thread; i <= slice.last; i += kThreads) sum += coarse[row + i].rgb;
  partial[thread] = sum;
  barrier();
  if (thread == 0u) {
    vec3 all = vec3(0.0);
    for (uint i = 0u; i < kThreads; ++i) all += partial[i];
    floor_light = max(all * (kDark / float(slice.last + 1u)), vec3(1e-30));
  }
  barrier();
  for (uint i = thread; i < slice.last; i += kThreads) {
    if (is_break(row + i)) atomicOr(breaks[i >> 5u], 1u << (i & 31u));
  }
  barrier();

  uint fine_step = max(epipolar.initial_step / epipolar.epipole_density, 1u);
  float near_epipole = 0.05 * float(max(frame.width, frame.height));
  for (uint i = thread; i <= slice.last; i += kThreads) {
    uint from = i / epipolar.initial_step * epipolar.initial_step;
    uint to = from + epipolar.initial_step;
    bool near = epipolar.sun_in_picture != 0u && from * 20u < epipolar.samples &&
                distance(sample_position(slice, from), epipole()) < near_epipole;
    if (near) {
      from += (i - from) / fine_step * fine_step;
      to = min(to, from + fine_step);
    }
    to = min(to, slice.last);
    from = min(from, to);
    uint left = left_source(from, i);
    uint right = right_source(i, to);
    if (left == i || right == i) {
      left = i;
      right = i;
      atomicOr(marched[i >> 5u], 1u << (i & 31u));
    }
    sources[row + i] = left | right << 16u;
  }
  barrier();
  if (thread == 0u) {
    uint total = 0u;
    for (uint word = 0u; word < kWords; ++word) {
      before[word] = total;
      total += uint(bitCount(marched[word]));
    }
    list_start = atomicAdd(march.count, total);
    uint groups = (list_start + total + kMarchGroup - 1u) / kMarchGroup;
    atomicMax(march.groups_x, groups_along_x(groups));
    atomicMax(march.groups_y, groups_along_y(groups));
  }
  barrier();
  for (uint i = thread; i <= slice.last; i += kThreads) {
    uint word = i >> 5u;
    uint bit = 1u << (i & 31u);
    if ((marched[word] & bit) != 0u) {
      march_list[list_start + before[word] + uint(bitCount(marched[word] & (bit - 1u)))] = id << 16u | i;
    }
  }
}
