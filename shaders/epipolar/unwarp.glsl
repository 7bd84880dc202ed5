// From slices to the picture: a place between four samples, two on each of two slices, weighted by nearness in
// the picture and in depth (Yusov 2013, section 1.7). What is interpolated is the source and the optical depth
// per metre; the place's own depth makes light of them, so that a sample of another depth is a fair substitute
// where there is none of its own. Include after declaring medium, frame, epipolar, slices, samples.
#ifndef TYNDALL_UNWARP_GLSL
#define TYNDALL_UNWARP_GLSL

#include "lib/optical_depth.glsl"
#include "epipolar/ray_end.glsl"
#include "epipolar/slices.glsl"
#include "shared/constant_ids.h"

layout(constant_id = kExtinctionId) const uint kExtinction = 0u;  // 0 epipolar, 1 per pixel
layout(constant_id = kSparsityId) const uint kSparsity = 0u;      // Sparsity of src/effect/frame_steps.hpp

const bool kSkyline = kSparsity >= 1u && !kHomogeneous;
const bool kSparse = kSparsity == 2u && !kHomogeneous;

const float kBeyond = 0.5;  // of the way between two samples
// Ratio of the roots of the densities of four samples (of 1.5 between these) from which on what lies a little beyond
// them is not told by them.
const float kUneven = 1.2247;

struct Blend {
  float weight;
  vec3 source;
  vec3 density;
};

// The four samples around a place: two on each of two slices, and how near each is in depth.
struct Around {
  Side side;
  float lower;        // slice
  vec2 first;         // sample on each of the two
  vec4 origin_lower;  // entry and axis of the two
  vec4 origin_upper;
  vec4 nearness;
  vec3 source[4];   // roots
  vec3 density[4];  // roots
};

float depth_nearness(float sample_m, float depth_m) {
  float tolerated = epipolar.threshold * max(max(sample_m, depth_m), 1.0);
  float nearness = tolerated / max(abs(sample_m - depth_m), tolerated);
  nearness *= nearness;
  return nearness * nearness;
}

float place_on_slice(vec4 origin, vec2 position) { return dot(position - origin.xy, origin.zw); }

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
    float place = clamp(place_on_slice(origin, position), 0.0, float(slice.last));
    uint first = min(uint(place), slice.last - 1u);
    if (i == 0)
      a.origin_lower = origin;
    else
      a.origin_upper = origin;
    a.first[i] = float(first);
    for (int k = 0; k < 2; ++k) {
      Sample s = unpack_roots(samples[id * epipolar.samples + first + uint(k)]);
      a.source[2 * i + k] = s.source;
      a.density[2 * i + k] = s.density;
      a.nearness[2 * i + k] = depth_nearness(s.depth_m, depth_m);
    }
  }
  return a;
}

// Whether air thins out from sample to sample, as beside the limb.
bool uneven(Around a) {
  vec3 least = min(min(a.density[0], a.density[1]), min(a.density[2], a.density[3]));
  vec3 most = max(max(a.density[0], a.density[1]), max(a.density[2], a.density[3]));
  return any(greaterThan(most, kUneven * least));
}

// How much the light changes among the four samples, as a fraction of the greatest (of roots).
float contrast(Around a) {
  vec3 least = min(min(a.source[0], a.source[1]), min(a.source[2], a.source[3]));
  vec3 most = max(max(a.source[0], a.source[1]), max(a.source[2], a.source[3]));
  vec3 change = (most - least) / max(most, vec3(1e-20));
  return max(change.r, max(change.g, change.b));
}

float least_nearness(Around a) { return min(min(a.nearness.x, a.nearness.y), min(a.nearness.z, a.nearness.w)); }

// Whether not all four end at about the depth that was asked for.
bool lopsided(Around a) { return least_nearness(a) < 0.5; }

// The same with roots of the source and the density, at a place that is as far away, and no farther than a pixel from
// that of around().
Blend blend_roots(Around a, vec2 position) {
  float part = slice_coordinate(position, a.side) - a.lower;
  // The last slice of all sides is next to the first.
  float all = float(epipolar.slices);
  part = part > 0.5 * all ? part - all : part < -0.5 * all ? part + all : part;
  // A little beyond the four, where they are so close that the place has moved out from between them.
  part = clamp(part, -kBeyond, 1.0 + kBeyond);
  vec2 along = clamp(vec2(place_on_slice(a.origin_lower, position), place_on_slice(a.origin_upper, position)) - a.first,
                     -kBeyond, 1.0 + kBeyond);
  vec4 bilinear = vec4((1.0 - part) * (1.0 - along.x), (1.0 - part) * along.x, part * (1.0 - along.y), part * along.y);
  bilinear = least_nearness(a) > 0.99 ? bilinear : max(bilinear, vec4(0.0));
  // The last term keeps the sum above zero, whatever the samples.
  vec4 w = bilinear * a.nearness + 1e-9;
  Blend b;
  b.weight = w.x + w.y + w.z + w.w;
  w /= b.weight;
  b.source = w.x * a.source[0] + w.y * a.source[1] + w.z * a.source[2] + w.w * a.source[3];
  b.density = w.x * a.density[0] + w.y * a.density[1] + w.z * a.density[2] + w.w * a.density[3];
  b.source = max(b.source, vec3(0.0));
  b.density = max(b.density, vec3(0.0));
  return b;
}

Blend blend(Around a, vec2 position) {
  Blend b = blend_roots(a, position);
  b.source *= b.source;
  b.density *= b.density;
  return b;
}

// In closed form, of a pixel's own ray.
vec3 own_optical_depth(vec2 position, float visible_m, bool sky) {
  Ray ray = ray_to_depth(frame, position, visible_m, sky);
  float start, end;
  if (!clip_to_atmosphere(medium, ray, start, end)) return vec3(0.0);
  return optical_depth(medium, density_integral_along(medium, ray.altitude, ray.cos_zenith, end));
}

// The background seen through the air, from blended samples. `visible_m`: view-space depth of what was drawn.
vec3 compose(Blend b, vec2 position, float depth_m, float visible_m, bool sky, vec3 background) {
  if (kHomogeneous) {
    vec3 direction = ray_direction(frame, position);
    vec3 through, lost;
    homogeneous_attenuation(length_in_homogeneous(direction, depth_m), through, lost);
    vec3 light = b.source * lost * homogeneous_phase(dot(direction, frame.direction_to_sun)) * frame.sun_irradiance;
    return frame.only == 0u ? light + background * through : light;
  }
  vec3 tau;
  if (kExtinction == 0u) {
    tau = optical_depth_at(b.density, depth_m);
  } else {
    tau = own_optical_depth(position, visible_m, sky);
  }
  vec3 through, lost;
  attenuation(tau, through, lost);
  vec3 color = b.source * lost * frame.sun_irradiance;
  return frame.only == 0u ? color + background * through : color;
}

#endif
