// Rounding of texels to half precision. Some devices truncate when they store a float in such an image, which darkens
// the fourth roots of the tables by 0.03 % on average, and their values by 0.14 %.
#ifndef TYNDALL_HALF_TEXEL_GLSL
#define TYNDALL_HALF_TEXEL_GLSL

// Returns the nearest numbers with eleven significant bits, which half precision holds exactly from 6.1e-5 to 65504.
vec3 nearest_half(vec3 value) {
  uvec3 bits = floatBitsToUint(value);
  return uintBitsToFloat((bits + 0xfffu + (bits >> 13u & 1u)) & 0xffffe000u);
}

vec4 half_texel(vec3 value) { return vec4(nearest_half(value), 1.0); }

#endif
