// The background: the sun's disc, and the moon if there is one, on the airglow.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/moon.glsl"

layout(location = 0) in vec2 ndc;
layout(location = 0) out vec4 radiance;

void main() {
  vec3 direction =
      normalize(mat3(local_from_view) * vec3((ndc.x - jitter.x) * tan_half.x, -(ndc.y - jitter.y) * tan_half.y, -1.0));
  radiance = vec4(beyond_air(direction), 1.0);
}
