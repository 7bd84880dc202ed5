// Interpolates the sky next to a skyline at low slice counts, where one of the two slices may be behind the ground.
#ifndef TYNDALL_SKYLINE_GLSL
#define TYNDALL_SKYLINE_GLSL

#include "epipolar/unwarp.glsl"

// The contribution of a slice to a position in the sky. The slice may be behind the ground there.
struct SkyOnSlice {
  Spectrum source;  // square root
  float away;       // distance to the samples that contribute [pixels]
  bool any;
};

bool in_sky(uint at) { return uintBitsToFloat(samples[at].x) >= kSkyDepth; }

SkyOnSlice sky_on_slice(uint id, vec4 origin, vec2 position) {
  uint row = id * epipolar.samples;
  int last = int(slices[id].last);
  float place = clamp(position_on_slice(origin, position), 0.0, float(last));
  int left = int(place);
  int right = min(left + 1, last);
  while (left >= 0 && !in_sky(row + uint(left))) --left;
  while (right <= last && !in_sky(row + uint(right))) ++right;
  bool any_left = left >= 0;
  bool any_right = right <= last;
  SkyOnSlice sky = SkyOnSlice(Spectrum(0.0), 0.0, any_left || any_right);
  if (!sky.any) return sky;
  left = any_left ? left : right;
  right = any_right ? right : left;
  float part = right > left ? clamp((place - float(left)) / float(right - left), 0.0, 1.0) : 0.0;
  sky.source = mix(LOAD_ROOTS(row + uint(left)).source, LOAD_ROOTS(row + uint(right)).source, part);
  float gap = min(abs(place - float(left)), abs(float(right) - place)) - 1.0;  // in samples
  sky.away = max(gap, 0.0) / max(length(origin.zw), 1e-9);
  return sky;
}

// Returns the source function at a position in the sky, from the nearest samples of both slices in the sky. The weight
// of a slice decreases with their distance, so that there is no seam where it leaves the ground. Returns `otherwise` if
// both slices are behind the ground.
Spectrum sky_source(Around a, vec2 position, Spectrum otherwise) {
  uint last = epipolar.slices - 1u;
  uint lower = uint(a.lower);
  uint upper = lower < last ? lower + 1u : epipolar.closed != 0u ? 0u : last;
  float part = clamp(slice_coordinate(position, a.side) - a.lower, 0.0, 1.0);
  float reach = epipolar.perimeter / float(epipolar.slices);  // the distance between slices
  SkyOnSlice sky[2] = SkyOnSlice[2](sky_on_slice(min(lower, last), a.origin_lower, position),
                                    sky_on_slice(upper, a.origin_upper, position));
  float sum = 0.0;
  Spectrum root = Spectrum(0.0);
  for (int i = 0; i < 2; ++i) {
    float far = sky[i].away / reach;
    float weight = sky[i].any ? (i == 0 ? 1.0 - part : part) / (1.0 + far * far) : 0.0;
    sum += weight;
    root += weight * sky[i].source;
  }
  root /= max(sum, 1e-20);
  return sum > 1e-6 ? root * root : otherwise;
}

#endif
