// The four pixels of the half- or quarter-resolution buffer around a full-resolution pixel.
#ifndef TYNDALL_DOWNSCALED_AROUND_GLSL
#define TYNDALL_DOWNSCALED_AROUND_GLSL

#include "epipolar/downscaled.glsl"
#include "epipolar/unwarp.glsl"

layout(std430, binding = 15) readonly buffer downscaled_inscattering_block { vec4 downscaled[]; };

// `part` is the fraction of the way from the first to the last. At the border of the picture there are fewer than four.
void downscaled_around(ivec2 pixel, out vec2 part, out Sample around[4]) {
  ivec2 at = downscaled_before(pixel, part);
  ivec2 most = ivec2(epipolar.downscaled_width, epipolar.downscaled_height) - 1;
  for (int k = 0; k < 4; ++k) {
    uint index = downscaled_index(clamp(at + ivec2(k & 1, k >> 1), ivec2(0), most));
    vec4 source = downscaled[index];
#ifdef SPECTRAL
    around[k].source = vec4(source.rgb, downscaled[FOURTH_PLANE + index].x);
#else
    around[k].source = source.rgb;
#endif
    around[k].depth_m = source.a;
    uint behind = epipolar.downscaled_width * epipolar.downscaled_height;
    around[k].extinction = kHomogeneous ? Spectrum(0.0) : CHANNELS(downscaled[behind + index]);
  }
}

vec4 bilinear_weights(vec2 part) {
  return vec4((1.0 - part.x) * (1.0 - part.y), part.x * (1.0 - part.y), (1.0 - part.x) * part.y, part.x * part.y);
}

Blend blend_downscaled(Sample around[4], vec4 w) {
  Blend b;
  b.weight = 1.0;
  b.source = w.x * around[0].source + w.y * around[1].source + w.z * around[2].source + w.w * around[3].source;
  b.extinction =
      w.x * around[0].extinction + w.y * around[1].extinction + w.z * around[2].extinction + w.w * around[3].extinction;
  return b;
}

#endif
