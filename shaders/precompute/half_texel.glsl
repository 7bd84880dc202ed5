// Rounding of texels to half precision. Some devices truncate when they store a float in such an image, which darkens
// the fourth roots of the tables by 0.03 % on average, and their values by 0.14 %.
#ifndef TYNDALL_HALF_TEXEL_GLSL
#define TYNDALL_HALF_TEXEL_GLSL

#include "lib/spectrum.glsl"

#ifdef SPECTRAL
#define SpectrumBits uvec4
#else
#define SpectrumBits uvec3
#endif

// Returns the nearest numbers with eleven significant bits, which half precision holds exactly from 6.1e-5 to 65504.
Spectrum nearest_half(Spectrum value) {
  SpectrumBits bits = floatBitsToUint(value);
  return uintBitsToFloat((bits + 0xfffu + (bits >> 13u & 1u)) & 0xffffe000u);
}

vec4 half_texel(Spectrum value) { return STORED(nearest_half(value), 1.0); }

#endif
