// Shows the depth buffer as distance on a logarithmic scale, from near (dark) to far (bright). The background is blue.
#version 460

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

layout(binding = 0) uniform sampler2D depth_picture;

layout(push_constant) uniform Push {
  float near_m;      // distance = near / depth
  float nearest_m;   // shown black
  float farthest_m;  // shown white
}
push;

void main() {
  float depth = textureLod(depth_picture, uv, 0.0).r;
  vec3 shown = vec3(0.05, 0.1, 0.3);
  if (depth > 0.0) {
    float distance_m = push.near_m / depth;
    shown = vec3(log(distance_m / push.nearest_m) / log(push.farthest_m / push.nearest_m));
  }
  color = vec4(shown * shown, 1.0);
}
