// Interpolates a position of the picture between four samples, two on each of two slices. The weights are bilinear and
// decrease with the difference in depth (Yusov 2013, section 1.7). The mean source function and the mean extinction
// coefficient are interpolated; in-scattering follows from them and from the depth of the pixel itself. A sample at
// another depth is therefore a good substitute if there is none at the depth of the pixel.
#ifndef TYNDALL_UNWARP_GLSL
#define TYNDALL_UNWARP_GLSL

#include "lib/optical_depth.glsl"
#include "epipolar/ray_end.glsl"
#include "epipolar/slices.glsl"
#include "shared/constant_ids.h"
#include "shared/params.glsl"

layout(constant_id = kExtinctionId) const uint kExtinction = Extinction_epipolar;
layout(constant_id = kSparsityId) const uint kSparsity = kSparsityNone;
layout(std430, binding = 13) readonly buffer slices_block { EpipolarSlice slices[]; };
layout(std430, binding = 14) readonly buffer samples_block { uvec4 samples[]; };

const bool kSkyline = kSparsity >= kSparsitySkyline && !kHomogeneous;
const bool kSparse = kSparsity == kSparsityAll && !kHomogeneous;

const float kMaxExtrapolation = 0.5;  // fraction of the distance between two samples
// If the extinction coefficients of the four samples differ by a larger factor than 1.5, they cannot be extrapolated.
// This is the square root of that factor, because the samples hold square roots.
const float kMaxExtinctionRatio = 1.2247;

struct Blend {
  float weight;  // sum of the weights before normalisation
  Spectrum source;
  Spectrum extinction;
};

// The four samples around a position, two on each of two slices. Samples 0 and 1 are on the lower slice.
struct Around {
  Side side;
  float lower;        // index of the lower slice
  vec2 first;         // index of the first sample on each slice
  vec4 origin_lower;  // EpipolarSlice::line of both
  vec4 origin_upper;
  vec4 nearness;           // weights by depth, at most 1
  Spectrum source[4];      // square roots
  Spectrum extinction[4];  // square roots
};

// Returns the weight of a sample for a pixel at another depth: 1 up to the tolerance, and beyond it the fourth power of
// the tolerance over the relative difference.
float depth_nearness(float sample_m, float depth_m) {
  float tolerated = epipolar.depth_tolerance * max(max(sample_m, depth_m), 1.0);
  float nearness = tolerated / max(abs(sample_m - depth_m), tolerated);
  nearness *= nearness;
  return nearness * nearness;
}

// Returns the projection of a position onto a slice, in samples from its start.
float position_on_slice(vec4 origin, vec2 position) { return dot(position - origin.xy, origin.zw); }

// Returns the samples around a position, with weights for its depth.
Around around(vec2 position, float depth_m) {
  Around a;
  uint last = epipolar.slices - 1u;
  a.side = side_behind(position);
  uint lower = uint(slice_coordinate(position, a.side));
  a.lower = float(lower);
  for (int i = 0; i < 2; ++i) {
    uint id = lower + uint(i);
    id = id <= last ? id : epipolar.closed != 0u ? id - last - 1u : last;
    EpipolarSlice slice = slices[id];
    vec4 origin = slice.line;
    float along = clamp(position_on_slice(origin, position), 0.0, float(slice.last));
    uint first = min(uint(along), slice.last - 1u);
    if (i == 0)
      a.origin_lower = origin;
    else
      a.origin_upper = origin;
    a.first[i] = float(first);
    for (int k = 0; k < 2; ++k) {
      Sample s = LOAD_ROOTS(id * epipolar.samples + first + uint(k));
      a.source[2 * i + k] = s.source;
      a.extinction[2 * i + k] = s.extinction;
      a.nearness[2 * i + k] = depth_nearness(s.depth_m, depth_m);
    }
  }
  return a;
}

// Returns whether the extinction coefficient changes too much between the four samples, as it does next to the limb.
bool extinction_varies(Around a) {
  Spectrum low = min(min(a.extinction[0], a.extinction[1]), min(a.extinction[2], a.extinction[3]));
  Spectrum high = max(max(a.extinction[0], a.extinction[1]), max(a.extinction[2], a.extinction[3]));
  return any(greaterThan(high, kMaxExtinctionRatio * low));
}

// Returns the change of the mean source function among the four samples relative to the largest, both as square roots.
float contrast(Around a) {
  Spectrum low = min(min(a.source[0], a.source[1]), min(a.source[2], a.source[3]));
  Spectrum high = max(max(a.source[0], a.source[1]), max(a.source[2], a.source[3]));
  Spectrum change = (high - low) / max(high, Spectrum(1e-20));
  return LARGEST(change);
}

float min_nearness(Around a) { return min(min(a.nearness.x, a.nearness.y), min(a.nearness.z, a.nearness.w)); }

// Returns whether at least one of the four samples is at another depth than the pixel.
bool depths_differ(Around a) { return min_nearness(a) < 0.5; }

// Interpolates the square roots at a position that has the same depth as that of around(). It may lie outside the four
// samples; up to kMaxExtrapolation the blend is extrapolated.
Blend blend_roots(Around a, vec2 position) {
  float part = slice_coordinate(position, a.side) - a.lower;
  // If slices end on all four sides, the last is next to the first.
  float all = float(epipolar.slices);
  part = part > 0.5 * all ? part - all : part < -0.5 * all ? part + all : part;
  part = clamp(part, -kMaxExtrapolation, 1.0 + kMaxExtrapolation);
  vec2 along =
      clamp(vec2(position_on_slice(a.origin_lower, position), position_on_slice(a.origin_upper, position)) - a.first,
            -kMaxExtrapolation, 1.0 + kMaxExtrapolation);
  vec4 bilinear = vec4((1.0 - part) * (1.0 - along.x), (1.0 - part) * along.x, part * (1.0 - along.y), part * along.y);
  bilinear = min_nearness(a) > 0.99 ? bilinear : max(bilinear, vec4(0.0));
  // The last term makes the sum positive for all samples.
  vec4 w = bilinear * a.nearness + 1e-9;
  Blend b;
  b.weight = w.x + w.y + w.z + w.w;
  w /= b.weight;
  b.source = w.x * a.source[0] + w.y * a.source[1] + w.z * a.source[2] + w.w * a.source[3];
  b.extinction = w.x * a.extinction[0] + w.y * a.extinction[1] + w.z * a.extinction[2] + w.w * a.extinction[3];
  b.source = max(b.source, Spectrum(0.0));
  b.extinction = max(b.extinction, Spectrum(0.0));
  return b;
}

// Interpolates at a position as blend_roots(), and returns the squares.
Blend blend(Around a, vec2 position) {
  Blend b = blend_roots(a, position);
  b.source *= b.source;
  b.extinction *= b.extinction;
  return b;
}

// Returns the optical depth of a pixel's own ray in closed form.
Spectrum own_optical_depth(vec2 position, float visible_m, bool sky) {
  Ray ray = ray_to_depth(frame, position, visible_m, sky);
  float start, end;
  if (!clip_to_atmosphere(frame, medium, ray, start, end)) return Spectrum(0.0);
  return optical_depth(medium, density_integral_along(medium, ray.altitude, ray.cos_zenith, end));
}

// Returns the colour of a pixel from its mean source function, transmittance and opacity (1 - transmittance).
vec3 compose(Spectrum source, Spectrum transmittance, Spectrum opacity, vec3 background) {
  vec3 behind = frame.only == 0u ? background : vec3(0.0);
  return COMPOSED(source, transmittance, opacity, behind, frame.sun_irradiance);
}

// Returns the colour of a pixel: in-scattering from blended samples and the attenuated background. `visible_m`:
// view-space depth of what was drawn.
vec3 compose(Blend b, vec2 position, float depth_m, float visible_m, bool sky, vec3 background) {
  if (kHomogeneous) {
    vec3 direction = ray_direction(frame, position);
    Spectrum transmittance, opacity;
    homogeneous_attenuation(length_in_homogeneous(direction, depth_m), transmittance, opacity);
    Spectrum source = b.source * homogeneous_phase(dot(direction, frame.direction_to_sun));
    return compose(source, transmittance, opacity, background);
  }
  Spectrum tau;
  if (kExtinction == Extinction_epipolar) {
    tau = optical_depth_at(b.extinction, depth_m);
  } else {
    tau = own_optical_depth(position, visible_m, sky);
  }
  Spectrum transmittance, opacity;
  attenuation(tau, transmittance, opacity);
  return compose(b.source, transmittance, opacity, background);
}

#endif
