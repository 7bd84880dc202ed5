// Encodes linear values in [0; 1] for an 8-bit window: the sRGB curve (IEC 61966-2-1), dithered against banding.
#ifndef TYNDALL_VIEWER_ENCODE_GLSL
#define TYNDALL_VIEWER_ENCODE_GLSL

vec3 encoded(vec3 linear) {
  vec3 c = clamp(linear, vec3(0.0), vec3(1.0));
  vec3 curve = 1.055 * pow(max(c, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055;
  return mix(12.92 * c, curve, greaterThan(c, vec3(0.0031308)));
}

// Returns evenly distributed noise in [0; 1) for a pixel (Jimenez, "Next Generation Post Processing in Call of Duty",
// 2014, slide 123).
float noise_at(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

vec4 window_color(vec3 linear, vec2 pixel) {
  return vec4(encoded(linear) + (noise_at(floor(pixel)) - 0.5) / 255.0, 1.0);
}

#endif
