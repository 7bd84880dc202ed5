// Shows a 2D slice of a scattering table: one layer of the third axis.
#version 460

layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;

layout(binding = 0) uniform sampler3D table;

layout(push_constant) uniform Push {
  float slice;  // 0 to 1 along the third axis
}
push;

void main() { color = vec4(textureLod(table, vec3(uv.x, 1.0 - uv.y, push.slice), 0.0).rgb, 1.0); }
