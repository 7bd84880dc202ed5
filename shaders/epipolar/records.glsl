// A sample: the view-space depth of the end of its ray, the mean extinction coefficient up to that depth per megametre,
// and the mean source function L / (1 - T) relative to the sun's irradiance. The mean source function is interpolated
// because it changes slowly, while in-scattering follows every change of depth. Both are stored as square roots in half
// precision, with a relative error of 5e-4 over eighteen decades.
#ifndef TYNDALL_RECORDS_GLSL
#define TYNDALL_RECORDS_GLSL

const float kSkyDepth = 1e9;  // [m] of rays that leave the atmosphere
const float kLongest = 1e6;   // [m]; beyond this depth, the stored value is the optical depth itself

struct Sample {
  float depth_m;
  vec3 extinction;  // optical depth per megametre
  vec3 source;
};

float depth_in_megametres(float depth_m) { return max(min(depth_m, kLongest), 0.01) * 1e-6; }

vec3 extinction_of(vec3 optical_depth, float depth_m) { return optical_depth / depth_in_megametres(depth_m); }

// Computes exp(-tau), and 1 - exp(-tau) without cancellation.
void attenuation(vec3 tau, out vec3 transmittance, out vec3 opacity) {
  transmittance = exp(-tau);
  opacity = mix(1.0 - transmittance, tau - 0.5 * tau * tau, lessThan(tau, vec3(2e-3)));
}

vec3 optical_depth_at(vec3 extinction, float depth_m) { return extinction * depth_in_megametres(depth_m); }

vec3 root_for_half(vec3 x) { return min(sqrt(max(x, vec3(0.0))), vec3(65504.0)); }

uvec4 pack_sample(Sample s) {
  vec3 source = root_for_half(s.source);
  vec3 extinction = root_for_half(s.extinction);
  return uvec4(floatBitsToUint(s.depth_m), packHalf2x16(source.xy), packHalf2x16(vec2(source.z, extinction.x)),
               packHalf2x16(extinction.yz));
}

// Returns a sample with the square roots of its extinction coefficient and source function.
Sample unpack_roots(uvec4 packed) {
  vec2 a = unpackHalf2x16(packed.y);
  vec2 b = unpackHalf2x16(packed.z);
  vec2 c = unpackHalf2x16(packed.w);
  Sample s;
  s.depth_m = uintBitsToFloat(packed.x);
  s.source = vec3(a, b.x);
  s.extinction = vec3(b.y, c);
  return s;
}

Sample unpack_sample(uvec4 packed) {
  Sample s = unpack_roots(packed);
  s.source *= s.source;
  s.extinction *= s.extinction;
  return s;
}

const float kCoarseUnit = 1e6;  // in-scattering has full precision down to 1e-14

// Coarse unshadowed in-scattering for refine_samples.comp: the square roots of red and blue. Green lies between them.
uint pack_coarse(vec3 light) { return packHalf2x16(root_for_half(light * kCoarseUnit).xz); }

// Set by march_samples.comp if the ray of a marched sample has a shadowed end point. The sign bit is free because roots
// are never negative.
const uint kShadowedEnd = 0x80000000u;

// Set by slice_samples.comp if the ray of a sample ends in the sky.
const uint kSkySample = 0x8000u;

float shadowed_end(uint coarse) { return (coarse & kShadowedEnd) != 0u ? 1.0 : 0.0; }

// In-scattering of a pixel that was marched separately: square roots in half precision, as in samples.
uvec2 pack_light(vec3 light) {
  vec3 root = root_for_half(light * kCoarseUnit);
  return uvec2(packHalf2x16(root.xy), packHalf2x16(vec2(root.z, 0.0)));
}

vec3 unpack_light(uvec2 packed) {
  vec3 root = vec3(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y).x);
  return root * root / kCoarseUnit;
}

vec2 unpack_coarse(uint packed) {
  vec2 root = unpackHalf2x16(packed);
  return root * root;
}

#endif
