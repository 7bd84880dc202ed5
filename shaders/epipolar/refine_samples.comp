// Chooses the samples that are marched, and for the others the two that they are interpolated between
// (Yusov 2013, section 1.3). Marched are samples where the unshadowed light is off the line between its neighbours' by
// more than kOff times the threshold: first next to each, which finds edges, then halving the steps between, which
// finds slow bends. One group per slice, and a thread for each run of kRun samples: marked samples are bits, and each
// sample looks for the nearest to both sides. sources: index of the left source, and of the right one << 16, on the
// same slice; equal where it is marched. The list of marched samples, slice << 16 | index, keeps the order of each
// slice.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"
#include "shared/constant_ids.h"

const uint kThreads = 32u;

layout(local_size_x = kThreads) in;
layout(constant_id = kRefinementId) const uint kRefinement = 1u;  // 0 by depth, 1 by in-scattering

layout(std430, binding = 0) readonly buffer frame_block { FrameConstants frame; };
layout(std430, binding = 1) readonly buffer epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 2) buffer slices_block { EpipolarSlice slices[]; };
layout(std430, binding = 3) readonly buffer coarse_inscattering_block { uint coarse[]; };
layout(std430, binding = 6) readonly buffer samples_block { uvec4 samples[]; };
layout(std430, binding = 4) writeonly buffer interpolation_sources_block { uint sources[]; };
layout(std430, binding = 5) buffer march_list_block {
  WorkList march;
  uint march_list[];
};

#include "epipolar/records.glsl"
#include "epipolar/slices.glsl"
#include "epipolar/work_list.glsl"

const uint kWords = 64u;  // for 2048 samples
const uint kRun = 8u;     // samples; a part of a word
// Light below this part of the slice's mean makes no break: it is too dark to be seen beside the rest.
const float kDark = 0.05;
// Times the threshold: interpolation knows what is off the line, and makes up for most of it.
const float kOff = 1.5;
const uint kSparse = 4u;  // of this many samples one counts for the mean
const uint kPartials = 8u;

shared uint marked[kWords];  // bit i: sample i
shared uint before[kWords];  // marked samples in the words before
shared vec2 partial[kThreads];
shared uint list_start;

// How far light b is off the line between a and c, a part of the way from a.
float off_line(vec2 a, vec2 b, vec2 c, float part, vec2 floor_light) {
  vec2 off = abs(mix(a, c, part) - b) / max(max(a, max(b, c)), floor_light);
  return max(off.x, off.y);
}

float off_line(uint row, uint left, uint i, uint right, vec2 floor_light) {
  return off_line(unpack_coarse(coarse[row + left]), unpack_coarse(coarse[row + i]), unpack_coarse(coarse[row + right]),
                  float(i - left) / float(right - left), floor_light);
}

// Of samples and steps up to 2048. (CPU devices divide integers one by one.)
uint remainder_of(uint i, uint divisor) { return i - uint((float(i) + 0.5) / float(divisor)) * divisor; }

float depth_step(uint at) {
  float depth = uintBitsToFloat(samples[at].x);
  vec2 others = uintBitsToFloat(uvec2(samples[at - 1u].x, samples[at + 1u].x));
  vec2 change = abs(others - depth) / max(max(others, depth), 1.0);
  return max(change.x, change.y);
}

// Whether a sample ends at another surface than one of its neighbours.
bool at_depth_break(uint at) {
  float depth = uintBitsToFloat(samples[at].x);
  vec2 others = uintBitsToFloat(uvec2(samples[at - 1u].x, samples[at + 1u].x));
  vec2 ratio = min(others, depth) / max(max(others, depth), 1e-3);
  return min(ratio.x, ratio.y) < epipolar.depth_break;
}

// The last of the first samples of a slice, up to a number of them, that ends at another depth than the one before; 0:
// none does.
uint last_break(uint row, uint count) {
  const float kOtherSurface = 0.8;  // ratio of depths, at most
  float before = uintBitsToFloat(samples[row].x);
  uint found = 0u;
  for (uint i = 1u; i < count; ++i) {
    float depth = uintBitsToFloat(samples[row + i].x);
    found = min(depth, before) < kOtherSurface * max(depth, before) ? i : found;
    before = depth;
  }
  return found;
}

uint left_marked(uint i) {
  uint word = i >> 5u;
  uint bits = marked[word] & (0xFFFFFFFFu >> (31u - (i & 31u)));
  while (bits == 0u) bits = marked[--word];
  return word * 32u + uint(findMSB(bits));
}

uint right_marked(uint i) {
  uint word = i >> 5u;
  uint bits = marked[word] & (0xFFFFFFFFu << (i & 31u));
  while (bits == 0u) bits = marked[++word];
  return word * 32u + uint(findLSB(bits));
}

void main() {
  uint id = gl_WorkGroupID.x;
  uint thread = gl_LocalInvocationID.x;
  EpipolarSlice slice = slices[id];
  uint row = id * epipolar.samples;
  for (uint w = thread; w < kWords; w += kThreads) marked[w] = 0u;
  vec2 sum = vec2(0.0);
  for (uint i = thread * kSparse; i <= slice.last; i += kThreads * kSparse) sum += unpack_coarse(coarse[row + i]);
  partial[thread] = sum;
  barrier();
  if (thread < kPartials) {
    for (uint i = thread + kPartials; i < kThreads; i += kPartials) sum += partial[i];
    partial[thread] = sum;
  }
  barrier();
  sum = vec2(0.0);
  for (uint i = 0u; i < kPartials; ++i) sum += partial[i];
  vec2 floor_light = max(sum * (kDark / float(slice.last / kSparse + 1u)), vec2(1e-30));

  // Once, not in the loops: a device without a GPU loads from buffers for each invocation.
  const uint initial_step = epipolar.initial_step;
  const float threshold = epipolar.threshold;
  const vec2 center = epipole();
  // Of samples, those that may be near the epipole.
  const uint near_samples = epipolar.sun_in_picture != 0u ? (epipolar.samples + 19u) / 20u : 0u;
  uint fine_step = max(initial_step / epipolar.epipole_density, 1u);
  float near_epipole = 0.05 * float(max(frame.width, frame.height));
  for (uint first = thread * kRun; first <= slice.last; first += kThreads * kRun) {
    uint bits = 0u;
    vec2 a = unpack_coarse(coarse[row + max(first, 1u) - 1u]);
    vec2 b = unpack_coarse(coarse[row + first]);
    for (uint i = first; i < first + kRun; ++i) {
      vec2 c = unpack_coarse(coarse[row + min(i + 1u, slice.last)]);
      uint beyond = remainder_of(i, initial_step);
      uint from = i - beyond;
      bool near = from < near_samples && distance(sample_position(slice, from), center) < near_epipole;
      bool mark = remainder_of(beyond, near ? fine_step : initial_step) == 0u || i == slice.last;
      bool kink = !mark && (kRefinement == 0u ? depth_step(row + min(i, slice.last - 1u)) > 0.2 * threshold
                                              : off_line(a, b, c, 0.5, floor_light) > kOff * threshold);
      bits |= i <= slice.last && (mark || kink) ? 1u << (i & 31u) : 0u;
      a = b;
      b = c;
    }
    atomicOr(marked[first >> 5u], bits);
  }
  if (epipolar.depth_break > 0.0) {
    for (uint i = 1u + thread; i < slice.last; i += kThreads) {
      if (at_depth_break(row + i)) atomicOr(marked[i >> 5u], 1u << (i & 31u));
    }
  }
  barrier();
  // Next to the epipole shadows change from sample to sample by an edge, on the face of what is in front of the sun
  // too, whose own light says nothing about it: all samples up to the last edge are marched there.
  const float kAround = 2.0;  // times as far as initial samples are denser
  if (thread == 0u && epipolar.sun_in_picture != 0u) {
    uint count = min(uint(kAround * near_epipole / max(length(slice.stride), 1e-6)), slice.last) + 1u;
    uint last = last_break(row, count);
    for (uint i = 0u; i < last; ++i) atomicOr(marked[i >> 5u], 1u << (i & 31u));
  }
  barrier();
  // What bends slowly has no kink: the middles of steps, of their halves and so on, against what is marked on both
  // sides so far.
  if (kRefinement == 1u) {
    uint segment = initial_step;
    for (uint from = thread * segment; from < slice.last; from += kThreads * segment) {
      uint end = min(from + segment, slice.last);
      for (uint part = segment / 2u; part > 1u; part /= 2u) {
        for (uint i = from + part; i < end; i += 2u * part) {
          uint left = left_marked(i);
          uint right = right_marked(i);
          if (left != right && off_line(row, left, i, right, floor_light) > kOff * threshold) {
            atomicOr(marked[i >> 5u], 1u << (i & 31u));
          }
        }
      }
    }
  }
  barrier();
  if (thread == 0u) {
    uint total = 0u;
    for (uint word = 0u; word <= slice.last >> 5u; ++word) {
      before[word] = total;
      total += uint(bitCount(marked[word]));
    }
    list_start = atomicAdd(march.count, total);
    slices[id].first_marched = list_start;
    uint groups = (list_start + total + kMarchGroup - 1u) / kMarchGroup;
    atomicMax(march.groups_x, groups_along_x(groups));
    atomicMax(march.groups_y, groups_along_y(groups));
  }
  barrier();
  for (uint first = thread * kRun; first <= slice.last; first += kThreads * kRun) {
    uint word = first >> 5u;
    uint bits = marked[word];
    uint left = left_marked(first);
    uint behind = right_marked(min(first + kRun - 1u, slice.last));
    uint at = list_start + before[word] + uint(bitCount(bits & ((1u << (first & 31u)) - 1u)));
    uint end = min(first + kRun, slice.last + 1u);
    for (uint i = first; i < end; ++i) {
      uint onwards = bits >> (i & 31u);
      bool here = (onwards & 1u) != 0u;
      left = here ? i : left;
      uint right = onwards != 0u ? i + uint(findLSB(onwards)) : behind;
      sources[row + i] = left | right << 16u;
      if (here) march_list[at++] = id << 16u | i;
    }
  }
}
