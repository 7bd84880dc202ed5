// Discards the holes of alpha-tested meshes in the shadow maps.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/mesh_push.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 vertex_color;

layout(binding = 3) uniform sampler2D base_color;

void main() {
  if (texture(base_color, uv).a * push.color.a * vertex_color.a < push.alpha_cutoff) discard;
}
