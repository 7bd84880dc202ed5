// A sample as the picture is put together from it: view-space depth of where its ray ends; optical depth per
// megametre of that depth, in logarithmic 16 bits; and the source, the light that the air sends divided by
// what it takes away, L / (1 - T), as square roots in half precision, relative to the sun's irradiance. What
// is interpolated is the source, which changes slowly, and not the light, which follows every change of depth.
#ifndef TYNDALL_RECORDS_GLSL
#define TYNDALL_RECORDS_GLSL

const float kSkyDepth = 1e9;       // [m] of rays that leave the air
const float kLogLow = -24.0;       // log2 of the optical depth per megametre
const float kLogHigh = 24.0;
const float kLongest = 1e6;        // [m] Beyond this depth, what is stored is the optical depth itself.

struct Sample {
  float depth_m;
  vec3 log_density;  // log2 of the optical depth per megametre
  vec3 source;
};

float depth_in_megametres(float depth_m) { return max(min(depth_m, kLongest), 0.01) * 1e-6; }

vec3 log_density(vec3 optical_depth, float depth_m) {
  return log2(max(optical_depth / depth_in_megametres(depth_m), vec3(6e-8)));
}

// exp(-tau) and 1 - exp(-tau), the latter without cancellation.
void attenuation(vec3 tau, out vec3 through, out vec3 lost) {
  through = exp(-tau);
  lost = mix(1.0 - through, tau - 0.5 * tau * tau, lessThan(tau, vec3(2e-3)));
}

vec3 optical_depth_at(vec3 log_density, float depth_m) { return exp2(log_density) * depth_in_megametres(depth_m); }

uvec4 pack_sample(Sample s) {
  vec3 unit = clamp((s.log_density - kLogLow) / (kLogHigh - kLogLow), 0.0, 1.0);
  vec3 root = min(sqrt(max(s.source, vec3(0.0))), vec3(65504.0));
  uint blue = packHalf2x16(vec2(root.z, 0.0)) | (packUnorm2x16(vec2(0.0, unit.x)) & 0xFFFF0000u);
  return uvec4(floatBitsToUint(s.depth_m), packHalf2x16(root.xy), blue, packUnorm2x16(unit.yz));
}

Sample unpack_sample(uvec4 packed) {
  Sample s;
  s.depth_m = uintBitsToFloat(packed.x);
  vec3 root = vec3(unpackHalf2x16(packed.y), unpackHalf2x16(packed.z & 0xFFFFu).x);
  s.source = root * root;
  vec3 unit = vec3(float(packed.z >> 16u), float(packed.w & 0xFFFFu), float(packed.w >> 16u)) / 65535.0;
  s.log_density = kLogLow + (kLogHigh - kLogLow) * unit;
  return s;
}

#endif
