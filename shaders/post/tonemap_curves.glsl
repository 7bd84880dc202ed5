// Tone-mapping operators. Each maps scaled linear radiance (Rec. 709, 0 to kTonemapMax) to linear display values, which
// the caller clamps to [0; 1]. White points are scaled luminances. C++ compiles this file in double precision
// (src/post/curves.cpp). docs/tonemapping.md has the formulas and plots.
#ifndef TYNDALL_TONEMAP_CURVES_GLSL
#define TYNDALL_TONEMAP_CURVES_GLSL

#include "lib/portable.glsl"

// Values of post::Operator (src/post/tonemap.hpp).
const uint kTonemapExponential = 0u;
const uint kTonemapReinhard = 1u;
const uint kTonemapReinhardModified = 2u;
const uint kTonemapUncharted2 = 3u;
const uint kTonemapFilmicAlu = 4u;
const uint kTonemapLogarithmic = 5u;
const uint kTonemapAdaptiveLogarithmic = 6u;
const uint kTonemapAgx = 7u;
const uint kTonemapPbrNeutral = 8u;
const uint kTonemapExponentialChannels = 9u;

// The largest input. Every curve reaches white far below it, and its square does not overflow.
const float kTonemapMax = 1.0e9;

// Returns a channel clamped to [0; kTonemapMax]. NaN becomes 0 because the comparison fails.
float tonemap_fit(float value) { return value > 0.0 ? min(value, kTonemapMax) : 0.0; }

vec3 tonemap_scaled(vec3 radiance, float exposure) {
  return vec3(tonemap_fit(radiance.x * exposure), tonemap_fit(radiance.y * exposure),
              tonemap_fit(radiance.z * exposure));
}

// Returns the Rec. 709 luminance with the weights of Yusov (2013).
float tonemap_luminance(vec3 c) { return dot(c, vec3(0.212671, 0.715160, 0.072169)); }

// Applies a mapped luminance to a colour: its channel ratios are raised to the power of the saturation.
vec3 tonemap_colored(vec3 c, float luminance, float mapped, float saturation) {
  vec3 ratio = c / luminance;
  if (saturation != 1.0) ratio = pow(ratio, vec3(saturation));
  return mapped * ratio;
}

// The filmic curve of Hable ("Uncharted 2: HDR Lighting", GDC 2010).
vec3 tonemap_hable(vec3 x) {
  float a = 0.15;
  float b = 0.50;
  float c = 0.10;
  float d = 0.20;
  float e = 0.02;
  float f = 0.30;
  return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

// The filmic curve of Hejl and Burgess-Dawson ("Filmic Tonemapping for Real-time Rendering", SIGGRAPH course, 2010).
// The fit includes the display's gamma of 2.2, which is undone here.
vec3 tonemap_filmic_alu(vec3 c) {
  vec3 x = max(c - 0.004, vec3(0.0));
  vec3 encoded = (x * (6.2 * x + 0.5)) / (x * (6.2 * x + 1.7) + 0.06);
  return pow(encoded, vec3(2.2));
}

// The operator of Drago, Myszkowski, Annen and Chiba ("Adaptive Logarithmic Mapping for Displaying High Contrast
// Scenes", 2003), equation 4 with bias 0.85; the exponent is ln(0.85) / ln(0.5).
float tonemap_drago(float luminance, float white_point) {
  float base = log(2.0 + 8.0 * pow(luminance / white_point, 0.23446525363702297));
  return log(1.0 + luminance) * 2.302585092994046 / (log(1.0 + white_point) * base);
}

// AgX of Sobotka (2022), approximated as in Wrensch ("Minimal AgX Implementation", 2023): inset primaries, log2 over
// 16.5 stops around middle grey, a polynomial of degree six, and the inverse of the inset. Saturation is applied as in
// AgX's look.
vec3 tonemap_agx(vec3 c, float saturation) {
  mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992, 0.878468636469772,
                    0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104);
  mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368, 1.15190312990417,
                     -0.0980434501171241, -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
  float min_ev = -12.47393;
  float max_ev = 4.026069;
  vec3 ev = clamp(log2(max(inset * c, vec3(1.0e-10))), vec3(min_ev), vec3(max_ev));
  vec3 x = (ev - min_ev) / (max_ev - min_ev);
  vec3 curve = 0.1191 + x * (0.4298 + x * (-6.868 + x * (31.96 + x * (-40.14 + x * 15.5))));
  vec3 encoded = x * curve - 0.00232;
  vec3 grey = vec3(dot(encoded, vec3(0.2126, 0.7152, 0.0722)));
  encoded = outset * (grey + saturation * (encoded - grey));
  return pow(max(encoded, vec3(0.0)), vec3(2.2));
}

// Khronos PBR Neutral (2024): colours below 0.8 only lose the 4 % that the surface reflects; brighter ones are
// compressed and desaturated. The input is scaled as in DiligentFX (2024), which uses 0.3 for middle grey instead of
// 0.18.
vec3 tonemap_pbr_neutral(vec3 c) {
  float start = 0.8 - 0.04;
  float desaturation = 0.15;
  vec3 x = c * (0.3 / 0.18);
  float least = min(x.x, min(x.y, x.z));
  vec3 base = x - (least < 0.08 ? least - 6.25 * least * least : 0.04);
  float peak = max(base.x, max(base.y, base.z));
  if (peak < start) return base;
  float room = 1.0 - start;
  float new_peak = 1.0 - room * room / (peak + room - start);
  float white = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
  return mix(base * (new_peak / peak), vec3(new_peak), white);
}

// Applies the selected operator. `c` comes from tonemap_scaled().
vec3 tonemap_apply(uint operator_index, vec3 c, float white_point, float saturation) {
  if (operator_index == kTonemapUncharted2) return tonemap_hable(2.0 * c) / tonemap_hable(vec3(white_point));
  if (operator_index == kTonemapFilmicAlu) return tonemap_filmic_alu(c);
  if (operator_index == kTonemapAgx) return tonemap_agx(c, saturation);
  if (operator_index == kTonemapPbrNeutral) return tonemap_pbr_neutral(c);
  // O'Neil ("Accurate Atmospheric Scattering", GPU Gems 2, 2005, chapter 16).
  if (operator_index == kTonemapExponentialChannels) return vec3(1.0) - exp(-c);
  float l = tonemap_luminance(c);
  if (l <= 1.0e-30) return vec3(0.0);
  float mapped = 1.0 - exp(-l);
  if (operator_index == kTonemapReinhard) mapped = l / (1.0 + l);
  if (operator_index == kTonemapReinhardModified) mapped = l * (1.0 + l / (white_point * white_point)) / (1.0 + l);
  if (operator_index == kTonemapLogarithmic) mapped = log(1.0 + l) / log(1.0 + white_point);
  if (operator_index == kTonemapAdaptiveLogarithmic) mapped = tonemap_drago(l, white_point);
  return tonemap_colored(c, l, mapped, saturation);
}

#endif
