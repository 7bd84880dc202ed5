// Shows one layer of the shadow maps as a square in the middle of the window. Depths near the sun are dark.
#version 460

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

layout(binding = 0) uniform sampler2DArray layers;

layout(push_constant) uniform Push {
  float aspect;  // of the window
  float layer;
  float gain;  // stretches the depths around 0.5
}
push;

void main() {
  vec2 p = (uv - 0.5) * (push.aspect > 1.0 ? vec2(push.aspect, 1.0) : vec2(1.0, 1.0 / push.aspect)) + 0.5;
  vec3 shown = vec3(0.02, 0.03, 0.04);
  if (all(greaterThanEqual(p, vec2(0.0))) && all(lessThan(p, vec2(1.0)))) {
    float depth = textureLod(layers, vec3(p, push.layer), 0.0).r;
    shown = depth >= 1.0 ? vec3(0.0, 0.02, 0.1) : vec3(clamp((depth - 0.5) * push.gain + 0.5, 0.0, 1.0));
  }
  color = vec4(shown, 1.0);
}
