// Computes the exposure from the histogram. The eye adapts to a weighted log-average luminance.
// The weights are relative to the bright part of the picture, not absolute luminances as in DiligentFX (2019). The
// bright part is the luminance below which a fraction kBrightShare of the non-black samples lies. Samples that are
// kNoneStops darker count as black space and have no weight; from kFullStops darker upwards, samples have full weight.
// A planet against black space is thus exposed like one that fills the picture, by day and in twilight.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/exposure.h"

layout(local_size_x = 256) in;

layout(std430, binding = 0) readonly buffer CountsBlock { LuminanceCounts counts; }
counts_block;
layout(std430, binding = 1) buffer ExposureBlock { ExposureState state; }
exposure_block;

layout(push_constant) uniform Push {
  float seconds;  // since the previous picture
  float middle_gray;
  float least_luminance;
  uint cut;  // 1: history reset, there is no previous picture
}
push;

const float kBrightShare = 0.95;
const float kNoneStops = 7.0;
const float kFullStops = 5.0;
const float kRate = 1.0;              // adaptation rate [1/s], as in Yusov (2013)
const float kFullRateCounted = 1e-3;  // mean weight above which the eye adapts at the full rate
const float kFirstLuminance = 0.1;    // until a picture has weight (Yusov 2013)

shared float bins[kLuminanceBins];

float stop_of(uint bin) { return kLowestStop + kStopsPerBin * float(bin); }

// Returns the stop below which a fraction kBrightShare of `total` lies, interpolated between bins.
float bright_stop(float total) {
  float below = 0.0;
  for (uint i = 0u; i < kLuminanceBins; ++i) {
    float next = below + bins[i];
    if (next >= kBrightShare * total && bins[i] > 0.0) {
      return stop_of(i) + kStopsPerBin * ((kBrightShare * total - below) / bins[i] - 0.5);
    }
    below = next;
  }
  return stop_of(kLuminanceBins - 1u);
}

void main() {
  uint index = gl_LocalInvocationIndex;
  bins[index] = float(counts_block.counts.bins[index]);
  barrier();
  if (index != 0u) return;
  // A single invocation sums in order, so that every run gives the same result.
  float lit = 0.0;
  for (uint i = 0u; i < kLuminanceBins; ++i) lit += bins[i];
  float all = lit + float(counts_block.counts.black);
  float bright = lit > 0.0 ? bright_stop(lit) : kLowestStop;
  float weight_sum = 0.0;
  float stop_sum = 0.0;
  for (uint i = 0u; i < kLuminanceBins; ++i) {
    float weight = smoothstep(bright - kNoneStops, bright - kFullStops, stop_of(i)) * bins[i];
    weight_sum += weight;
    stop_sum += weight * stop_of(i);
  }
  bool any = weight_sum > 0.0;
  ExposureState state = exposure_block.state;
  state.measured = any ? exp2(stop_sum / weight_sum) : 0.0;
  state.counted = any ? weight_sum / all : 0.0;
  state.bright = any ? exp2(bright) : 0.0;
  state.samples = uint(all / float(kSampleParts) + 0.5);
  state.unused_0 = 0.0;
  if (push.cut != 0u) state.adapted = 0u;
  if (state.adapted == 0u) {
    state.luminance = any ? state.measured : kFirstLuminance;
    state.adapted = any ? 1u : 0u;
  } else if (any) {
    float rate = kRate * min(state.counted / kFullRateCounted, 1.0);
    state.luminance = mix(state.luminance, state.measured, 1.0 - exp(-rate * push.seconds));
  }
  state.exposure = push.middle_gray / max(state.luminance, push.least_luminance);
  exposure_block.state = state;
}
