// Writes the half- or quarter-resolution buffer. It stores 32-bit floats: source functions and depths of all pixels,
// followed by extinction coefficients, which a homogeneous medium does not need. A shader that also reads the buffer
// defines READ_DOWNSCALED before its first include.
#ifndef TYNDALL_STORE_DOWNSCALED_GLSL
#define TYNDALL_STORE_DOWNSCALED_GLSL

#include "epipolar/downscaled.glsl"
#include "frame/homogeneous_medium.glsl"

#ifdef READ_DOWNSCALED
layout(std430, binding = 15) buffer downscaled_inscattering_block { vec4 downscaled[]; };
#else
layout(std430, binding = 15) writeonly buffer downscaled_inscattering_block { vec4 downscaled[]; };
#endif

void store_downscaled(ivec2 at, float depth_m, Spectrum source, Spectrum extinction) {
  downscaled[downscaled_index(at)] = vec4(source.rgb, depth_m);
  if (!kHomogeneous) {
    uint behind = epipolar.downscaled_width * epipolar.downscaled_height;
    downscaled[behind + downscaled_index(at)] = STORED(extinction, 0.0);
  }
#ifdef SPECTRAL
  downscaled[FOURTH_PLANE + downscaled_index(at)] = vec4(source.a, 0.0, 0.0, 0.0);
#endif
}

#endif
