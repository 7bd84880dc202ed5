// Shows one picture, or two side by side: one setting left of the divider, another right of it.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "viewer/encode.glsl"

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

layout(binding = 0) uniform sampler2D left_picture;
layout(binding = 1) uniform sampler2D right_picture;

layout(push_constant) uniform Push {
  float divider;     // uv; 1: only the left picture
  float line_width;  // uv
  float gain;
  uint difference;  // 1: show the absolute difference times gain
}
push;

void main() {
  vec3 left = textureLod(left_picture, uv, 0.0).rgb;
  vec3 shown = left * push.gain;
  if (push.divider < 1.0) {
    vec3 right = textureLod(right_picture, uv, 0.0).rgb;
    if (push.difference == 1u) {
      shown = abs(left - right) * push.gain;
    } else {
      shown = (uv.x < push.divider ? left : right) * push.gain;
      if (abs(uv.x - push.divider) < push.line_width) shown = vec3(1.0, 0.8, 0.2);
    }
  }
  color = window_color(shown, gl_FragCoord.xy);
}
