// A sample: the view-space depth of the end of its ray, the mean extinction coefficient up to that depth per megametre,
// and the mean source function L / (1 - T) relative to the sun's irradiance. The mean source function is interpolated
// because it changes slowly, while in-scattering follows every change of depth. Both are stored as square roots in half
// precision, with a relative error of 5e-4 over eighteen decades.
#ifndef TYNDALL_RECORDS_GLSL
#define TYNDALL_RECORDS_GLSL

#include "lib/half.glsl"
#include "lib/spectrum.glsl"

const float kSkyDepth = 1e9;  // [m] of rays that leave the atmosphere
const float kLongest = 1e6;   // [m]; beyond this depth, the stored value is the optical depth itself

struct Sample {
  float depth_m;
  Spectrum extinction;  // optical depth per megametre
  Spectrum source;
};

float depth_in_megametres(float depth_m) { return max(min(depth_m, kLongest), 0.01) * 1e-6; }

Spectrum extinction_of(Spectrum optical_depth, float depth_m) { return optical_depth / depth_in_megametres(depth_m); }

// Computes exp(-tau), and 1 - exp(-tau) without cancellation.
void attenuation(Spectrum tau, out Spectrum transmittance, out Spectrum opacity) {
  transmittance = exp(-tau);
  opacity = mix(1.0 - transmittance, tau - 0.5 * tau * tau, lessThan(tau, Spectrum(2e-3)));
}

Spectrum optical_depth_at(Spectrum extinction, float depth_m) { return extinction * depth_in_megametres(depth_m); }

Spectrum root_for_half(Spectrum x) { return min(sqrt(max(x, Spectrum(0.0))), Spectrum(kLargestHalf)); }

uvec4 pack_sample(Sample s) {
  Spectrum source = root_for_half(s.source);
  Spectrum extinction = root_for_half(s.extinction);
  return uvec4(floatBitsToUint(s.depth_m), packHalf2x16(source.xy), packHalf2x16(vec2(source.z, extinction.x)),
               packHalf2x16(extinction.yz));
}

#ifdef SPECTRAL
// The fourth channels of source function and extinction coefficient do not fit into a sample. They follow all samples
// of the buffer, four samples in one element.
uint pack_fourth_channel(Sample s) {
  return packHalf2x16(vec2(root_for_half(s.source).w, root_for_half(s.extinction).w));
}

#define FOURTH_CHANNEL(at) samples[epipolar.slices * epipolar.samples + ((at) >> 2u)][(at)&3u]
#define STORE_SAMPLE(at, s)                      \
  {                                              \
    samples[at] = pack_sample(s);                \
    FOURTH_CHANNEL(at) = pack_fourth_channel(s); \
  }
#define LOAD_ROOTS(at) unpack_roots(samples[at], FOURTH_CHANNEL(at))
#else
#define STORE_SAMPLE(at, s) samples[at] = pack_sample(s);
#define LOAD_ROOTS(at) unpack_roots(samples[at])
#endif

// Returns a sample with the square roots of its extinction coefficient and source function.
#ifdef SPECTRAL
Sample unpack_roots(uvec4 packed, uint fourth_channel) {
#else
Sample unpack_roots(uvec4 packed) {
#endif
  vec2 a = unpackHalf2x16(packed.y);
  vec2 b = unpackHalf2x16(packed.z);
  vec2 c = unpackHalf2x16(packed.w);
  Sample s;
  s.depth_m = uintBitsToFloat(packed.x);
#ifdef SPECTRAL
  vec2 d = unpackHalf2x16(fourth_channel);
  s.source = vec4(a, b.x, d.x);
  s.extinction = vec4(b.y, c, d.y);
#else
  s.source = vec3(a, b.x);
  s.extinction = vec3(b.y, c);
#endif
  return s;
}

Sample squared(Sample s) {
  s.source *= s.source;
  s.extinction *= s.extinction;
  return s;
}

const float kCoarseUnit = 1e6;  // in-scattering has full precision down to 1e-14

// Coarse unshadowed in-scattering for refine_samples.comp: the square roots of the outermost channels. The
// others lie between them.
uint pack_coarse(Spectrum light) { return packHalf2x16(OUTER_CHANNELS(root_for_half(light * kCoarseUnit))); }

// Set by march_samples.comp if the ray of a marched sample has a shadowed end point. The sign bit is free because roots
// are never negative.
const uint kShadowedEnd = 0x80000000u;

// Set by slice_samples.comp if the ray of a sample ends in the sky.
const uint kSkySample = 0x8000u;

float shadowed_end(uint coarse) { return (coarse & kShadowedEnd) != 0u ? 1.0 : 0.0; }

// Packs the in-scattering of a pixel that was marched separately, as square roots in half precision like that of
// samples.
uvec2 pack_light(Spectrum light) {
  Spectrum root = root_for_half(light * kCoarseUnit);
#ifdef SPECTRAL
  return uvec2(packHalf2x16(root.xy), packHalf2x16(root.zw));
#else
  return uvec2(packHalf2x16(root.xy), packHalf2x16(vec2(root.z, 0.0)));
#endif
}

Spectrum unpack_light(uvec2 packed) {
#ifdef SPECTRAL
  vec4 root = vec4(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y));
#else
  vec3 root = vec3(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y).x);
#endif
  return root * root / kCoarseUnit;
}

vec2 unpack_coarse(uint packed) {
  vec2 root = unpackHalf2x16(packed);
  return root * root;
}

#endif
