// Selects the samples to be marched, and the two interpolation sources of every other sample (Yusov 2013, section 1.3).
// A sample is marched if its coarse unshadowed in-scattering deviates from the line between two others by more than
// kTolerance times the threshold. The first pass compares each sample with its neighbours, which finds edges. The
// second pass compares the middle of each step, of its halves and so on with the marked samples on both sides, which
// finds gradual changes.
//
// A workgroup processes one slice, and a thread kRun consecutive samples at a time. Marked samples are bits, which are
// searched for the nearest ones on both sides. `sources` stores the index of the left source and, shifted by 16 bits,
// of the right one, on the same slice; both are the sample itself if it is marched. The list of marched samples, slice
// << 16 | index, preserves the order within each slice.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "epipolar/constants.glsl"
#include "epipolar/records.glsl"
#include "epipolar/slices.glsl"
#include "epipolar/work_list.glsl"
#include "shared/constant_ids.h"
#include "shared/params.glsl"

#ifdef TARGET_GPU
const uint kThreads = 128u;  // with kRun = 2, one turn for 256 samples
#else
const uint kThreads = 32u;
#endif

layout(local_size_x = kThreads) in;
layout(constant_id = kRefineRunId) const uint kRun = 8u;  // consecutive samples of a thread, all in one word
layout(constant_id = kRefinementId) const uint kRefinement = Refinement_inscattering;

layout(std430, binding = 13) buffer slices_block { EpipolarSlice slices[]; };
layout(std430, binding = 15) readonly buffer coarse_inscattering_block { uint coarse[]; };
layout(std430, binding = 14) readonly buffer samples_block { uvec4 samples[]; };
layout(std430, binding = 16) writeonly buffer interpolation_sources_block { uint sources[]; };
layout(std430, binding = 17) buffer march_list_block {
  WorkList march;
  uint march_list[];
};

const uint kWords = 64u;  // for 2048 samples
// Deviations are relative to at least this fraction of the mean in-scattering of the slice. Deviations in darker parts
// are invisible next to the rest.
const float kDark = 0.05;
// Tolerated deviation in units of the threshold. It exceeds 1 because interpolate_samples.comp corrects most of the
// deviation.
const float kTolerance = 1.5;
const uint kMeanStride = 4u;  // every fourth sample is enough for the mean
const uint kPartials = 8u;    // threads of the second step of the sum

shared uint marked[kWords];  // bit i: sample i
shared uint before[kWords];  // number of marked samples in all previous words
shared vec2 partial[kThreads];
shared uint list_start;

// Returns the relative deviation of b from the line between a and c, at a fraction `part` of the way from a.
float deviation(vec2 a, vec2 b, vec2 c, float part, vec2 floor_light) {
  vec2 off = abs(mix(a, c, part) - b) / max(max(a, max(b, c)), floor_light);
  return max(off.x, off.y);
}

float deviation(uint row, uint left, uint i, uint right, vec2 floor_light) {
  return deviation(unpack_coarse(coarse[row + left]), unpack_coarse(coarse[row + i]),
                   unpack_coarse(coarse[row + right]), float(i - left) / float(right - left), floor_light);
}

// Returns i % divisor for numbers up to 2048. (CPU devices divide integers lane by lane.)
uint remainder_of(uint i, uint divisor) { return i - uint((float(i) + 0.5) / float(divisor)) * divisor; }

// Returns the largest relative change of depth from a sample to its neighbours.
float depth_step(uint at) {
  float depth = uintBitsToFloat(samples[at].x);
  vec2 others = uintBitsToFloat(uvec2(samples[at - 1u].x, samples[at + 1u].x));
  vec2 change = abs(others - depth) / max(max(others, depth), 1.0);
  return max(change.x, change.y);
}

// Returns whether there is a depth discontinuity between a sample and one of its neighbours, as EpipolarConstants
// defines it.
bool at_discontinuity(uint at) {
  float depth = uintBitsToFloat(samples[at].x);
  vec2 others = uintBitsToFloat(uvec2(samples[at - 1u].x, samples[at + 1u].x));
  vec2 ratio = min(others, depth) / max(max(others, depth), 1e-3);
  return min(ratio.x, ratio.y) < epipolar.discontinuity_ratio;
}

// Returns the index of the last sample before `count` that follows a depth discontinuity; 0 if there is none.
uint last_discontinuity(uint row, uint count) {
  const float kOtherSurface = 0.8;  // a smaller ratio of depths is a discontinuity
  float before = uintBitsToFloat(samples[row].x);
  uint found = 0u;
  for (uint i = 1u; i < count; ++i) {
    float depth = uintBitsToFloat(samples[row + i].x);
    found = min(depth, before) < kOtherSurface * max(depth, before) ? i : found;
    before = depth;
  }
  return found;
}

// Returns the nearest marked sample at or before sample i. The first sample of a slice is always marked.
uint left_marked(uint i) {
  uint word = i >> 5u;
  uint bits = marked[word] & (0xFFFFFFFFu >> (31u - (i & 31u)));
  while (bits == 0u) bits = marked[--word];
  return word * 32u + uint(findMSB(bits));
}

// Returns the nearest marked sample at or after sample i. The last sample of a slice is always marked.
uint right_marked(uint i) {
  uint word = i >> 5u;
  uint bits = marked[word] & (0xFFFFFFFFu << (i & 31u));
  while (bits == 0u) bits = marked[++word];
  return word * 32u + uint(findLSB(bits));
}

// The properties of a slice that its threads share. Loaded once, because CPU devices load from buffers lane by lane.
struct Work {
  EpipolarSlice slice;
  uint id;
  uint row;  // index of its first sample
  uint initial_step;
  float threshold;
  float near_epipole;  // distance from the epipole up to which initial samples are denser [pixels]
  vec2 floor_light;    // deviations are relative to at least this in-scattering
};

void mark(uint i) { atomicOr(marked[i >> 5u], 1u << (i & 31u)); }

// Returns the smallest in-scattering to which deviations are relative. All threads must call it.
vec2 find_floor_light(EpipolarSlice slice, uint row) {
  uint thread = gl_LocalInvocationID.x;
  vec2 sum = vec2(0.0);
  for (uint i = thread * kMeanStride; i <= slice.last; i += kThreads * kMeanStride)
    sum += unpack_coarse(coarse[row + i]);
  partial[thread] = sum;
  barrier();
  if (thread < kPartials) {
    for (uint i = thread + kPartials; i < kThreads; i += kPartials) sum += partial[i];
    partial[thread] = sum;
  }
  barrier();
  sum = vec2(0.0);
  for (uint i = 0u; i < kPartials; ++i) sum += partial[i];
  return max(sum * (kDark / float(slice.last / kMeanStride + 1u)), vec2(1e-30));
}

// Marks the initial samples, samples that deviate from both neighbours, and samples on both sides of a skyline. In
// turbid air, unshadowed in-scattering does not change at a skyline, because the path to the ground is opaque; light
// shafts do.
void mark_initial_samples_and_edges(Work w) {
  const vec2 center = epipole();
  // Only the first samples of a slice can be near the epipole.
  const uint near_samples = epipolar.sun_in_picture != 0u ? (epipolar.samples + 19u) / 20u : 0u;
  uint fine_step = max(w.initial_step / epipolar.epipole_density, 1u);
  for (uint first = gl_LocalInvocationID.x * kRun; first <= w.slice.last; first += kThreads * kRun) {
    uint bits = 0u;
    uint previous = coarse[w.row + max(first, 1u) - 1u];
    uint here = coarse[w.row + first];
    vec2 a = unpack_coarse(previous);
    vec2 b = unpack_coarse(here);
    for (uint i = first; i < first + kRun; ++i) {
      uint behind = coarse[w.row + min(i + 1u, w.slice.last)];
      vec2 c = unpack_coarse(behind);
      uint beyond = remainder_of(i, w.initial_step);
      uint from = i - beyond;
      bool near = from < near_samples && distance(sample_position(w.slice, from), center) < w.near_epipole;
      bool initial = remainder_of(beyond, near ? fine_step : w.initial_step) == 0u || i == w.slice.last;
      bool edge = !initial &&
                  (kRefinement == Refinement_depth ? depth_step(w.row + min(i, w.slice.last - 1u)) > 0.2 * w.threshold
                                                   : deviation(a, b, c, 0.5, w.floor_light) > kTolerance * w.threshold);
      bool skyline = (((previous ^ here) | (here ^ behind)) & kSkySample) != 0u;
      bits |= i <= w.slice.last && (initial || edge || skyline) ? 1u << (i & 31u) : 0u;
      previous = here;
      here = behind;
      a = b;
      b = c;
    }
    atomicOr(marked[first >> 5u], bits);
  }
}

// Marks the samples on both sides of all depth discontinuities, in twilight.
void mark_discontinuities(Work w) {
  if (epipolar.discontinuity_ratio <= 0.0) return;
  for (uint i = 1u + gl_LocalInvocationID.x; i < w.slice.last; i += kThreads) {
    if (at_discontinuity(w.row + i)) mark(i);
  }
}

// Next to the epipole, shadows change from sample to sample beside an edge, also on the dark face of an object in front
// of the sun. Unshadowed in-scattering gives no hint of it, so all samples up to the last edge are marked.
void mark_samples_near_epipole(Work w) {
  const float kAround = 2.0;  // in units of near_epipole
  if (gl_LocalInvocationID.x != 0u || epipolar.sun_in_picture == 0u) return;
  uint count = min(uint(kAround * w.near_epipole / max(length(w.slice.stride), 1e-6)), w.slice.last) + 1u;
  uint last = last_discontinuity(w.row, count);
  for (uint i = 0u; i < last; ++i) mark(i);
}

// Marks gradual changes: the middles of steps, of their halves and so on, compared with the nearest marked samples.
void mark_gradual_changes(Work w) {
  if (kRefinement != Refinement_inscattering) return;
  uint segment = w.initial_step;
  for (uint from = gl_LocalInvocationID.x * segment; from < w.slice.last; from += kThreads * segment) {
    uint end = min(from + segment, w.slice.last);
    for (uint part = segment / 2u; part > 1u; part /= 2u) {
      for (uint i = from + part; i < end; i += 2u * part) {
        uint left = left_marked(i);
        uint right = right_marked(i);
        if (left != right && deviation(w.row, left, i, right, w.floor_light) > kTolerance * w.threshold) mark(i);
      }
    }
  }
}

// Reserves room in the list for the marked samples.
void begin_list(Work w) {
  if (gl_LocalInvocationID.x != 0u) return;
  uint total = 0u;
  for (uint word = 0u; word <= w.slice.last >> 5u; ++word) {
    before[word] = total;
    total += uint(bitCount(marked[word]));
  }
  list_start = atomicAdd(march.count, total);
  slices[w.id].first_marched = list_start;
  uint groups = (list_start + total + kMarchGroup - 1u) / kMarchGroup;
  atomicMax(march.groups_x, groups_along_x(groups));
  atomicMax(march.groups_y, groups_along_y(groups));
}

// Stores the marked samples in the list, and the interpolation sources of all samples.
void store_sources(Work w) {
  for (uint first = gl_LocalInvocationID.x * kRun; first <= w.slice.last; first += kThreads * kRun) {
    uint word = first >> 5u;
    uint bits = marked[word];
    uint left = left_marked(first);
    uint behind = right_marked(min(first + kRun - 1u, w.slice.last));
    uint at = list_start + before[word] + uint(bitCount(bits & ((1u << (first & 31u)) - 1u)));
    uint end = min(first + kRun, w.slice.last + 1u);
    for (uint i = first; i < end; ++i) {
      uint onwards = bits >> (i & 31u);
      bool here = (onwards & 1u) != 0u;
      left = here ? i : left;
      uint right = onwards != 0u ? i + uint(findLSB(onwards)) : behind;
      sources[w.row + i] = left | right << 16u;
      if (here) march_list[at++] = w.id << 16u | i;
    }
  }
}

void main() {
  Work w;
  w.id = gl_WorkGroupID.x;
  w.slice = slices[w.id];
  w.row = w.id * epipolar.samples;
  for (uint i = gl_LocalInvocationID.x; i < kWords; i += kThreads) marked[i] = 0u;
  w.floor_light = find_floor_light(w.slice, w.row);
  w.initial_step = epipolar.initial_step;
  w.threshold = epipolar.threshold;
  w.near_epipole = 0.05 * float(max(frame.width, frame.height));
  mark_initial_samples_and_edges(w);
  mark_discontinuities(w);
  barrier();
  mark_samples_near_epipole(w);
  barrier();
  mark_gradual_changes(w);
  barrier();
  begin_list(w);
  barrier();
  store_sources(w);
}
