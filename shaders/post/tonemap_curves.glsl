// Tone-mapping curves; each maps scaled linear radiance to linear display values.
#ifndef TYNDALL_TONEMAP_CURVES_GLSL
#define TYNDALL_TONEMAP_CURVES_GLSL

#include "lib/portable.glsl"

// Rec. 709 luminance with the weights of the documents (Yusov 2013, after Reinhard et al. 2002).
float tonemap_luminance(vec3 c) {
  return dot(c, vec3(0.212671, 0.715160, 0.072169));
}

// 1 - exp(-L) on the luminance; colour keeps its ratios (O'Neil 2005, section 16.5, per luminance).
vec3 tonemap_exponential(vec3 c) {
  float luminance = tonemap_luminance(c);
  if (luminance <= 0.0) return vec3(0.0);
  return c * ((1.0 - exp(-luminance)) / luminance);
}

// Hable's filmic curve per channel (Hable, "Uncharted 2: HDR Lighting", 2010), with the documents' scale
// of 2 before the curve and the white point as it is.
vec3 uncharted2_curve(vec3 x) {
  float A = 0.15;
  float B = 0.50;
  float C = 0.10;
  float D = 0.20;
  float E = 0.02;
  float F = 0.30;
  return ((x * (A * x + vec3(C * B)) + vec3(D * E)) / (x * (A * x + vec3(B)) + vec3(D * F))) - vec3(E / F);
}

vec3 tonemap_uncharted2(vec3 c, float white_point) {
  vec3 white = uncharted2_curve(vec3(white_point));
  return uncharted2_curve(2.0 * c) / white;
}

#endif
