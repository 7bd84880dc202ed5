// The picture for which in-scattering is computed: the full-resolution picture, or with scattering.downscale the half-
// or quarter-resolution buffer, each pixel of which coincides with a pixel of the full resolution.
#ifndef TYNDALL_DOWNSCALED_GLSL
#define TYNDALL_DOWNSCALED_GLSL

#include "epipolar/constants.glsl"
#include "shared/constant_ids.h"

layout(constant_id = kDownscaleId) const int kDownscale = 1;

// The position of the first buffer pixel in the full resolution. It is even, so that the pixels of every 2 x 2 block
// lie between the same four buffer pixels.
const int kFirstDownscaled = kDownscale == 4 ? 2 : 0;

ivec2 computed_size() {
  return kDownscale == 1 ? ivec2(frame.width, frame.height)
                         : ivec2(epipolar.downscaled_width, epipolar.downscaled_height);
}

// Returns the full-resolution pixel of a buffer pixel. The last ones of a row or column may be closer together.
ivec2 pixel_of_downscaled(ivec2 at) {
  return min(at * kDownscale + kFirstDownscaled, ivec2(frame.width, frame.height) - 1);
}

// Returns the buffer pixel to the left of and above a pixel, at least -1, and the fraction of the way to the next one.
ivec2 downscaled_before(ivec2 pixel, out vec2 part) {
  ivec2 at = (pixel - kFirstDownscaled) >> (kDownscale / 2);
  part = vec2(pixel - kFirstDownscaled - at * kDownscale) / float(kDownscale);
  return at;
}

// With SPECTRAL, the buffer ends with the fourth channels of the source functions.
#define FOURTH_PLANE (kHomogeneous ? 1u : 2u) * (epipolar.downscaled_width * epipolar.downscaled_height)

uint downscaled_index(ivec2 at) { return uint(at.y) * epipolar.downscaled_width + uint(at.x); }

#endif
