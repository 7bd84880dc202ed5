// The picture that the light is computed for: the whole one, or with scattering.downscale the reduced one, each of
// whose pixels is one of the whole picture's. Include after declaring frame and epipolar.
#ifndef TYNDALL_REDUCED_GLSL
#define TYNDALL_REDUCED_GLSL

#include "shared/constant_ids.h"

layout(constant_id = kDownscaleId) const int kDownscale = 1;

// Of the first in the whole picture. Even, so that every block of 2 x 2 lies between the same four reduced pixels.
const int kFirstReduced = kDownscale == 4 ? 2 : 0;

ivec2 computed_size() {
  return kDownscale == 1 ? ivec2(frame.width, frame.height) : ivec2(epipolar.reduced_width, epipolar.reduced_height);
}

// The whole picture's pixel that a reduced one is; the last ones of a row or column may be closer together.
ivec2 pixel_of_reduced(ivec2 at) { return min(at * kDownscale + kFirstReduced, ivec2(frame.width, frame.height) - 1); }

// The reduced pixel to the left of and above a pixel, from -1 on, and the part of the way to the next.
ivec2 reduced_before(ivec2 pixel, out vec2 part) {
  ivec2 at = (pixel - kFirstReduced) >> (kDownscale / 2);
  part = vec2(pixel - kFirstReduced - at * kDownscale) / float(kDownscale);
  return at;
}

uint reduced_index(ivec2 at) { return uint(at.y) * epipolar.reduced_width + uint(at.x); }

// Full floats: source and depth, and behind those of all pixels the densities, which a homogeneous medium does without.
#define STORE_REDUCED(at, depth_m, blend)                               \
  {                                                                     \
    reduced[reduced_index(at)] = vec4((blend).source, depth_m);         \
    if (!kHomogeneous) {                                                \
      uint behind = epipolar.reduced_width * epipolar.reduced_height;   \
      reduced[behind + reduced_index(at)] = vec4((blend).density, 0.0); \
    }                                                                   \
  }

#endif
