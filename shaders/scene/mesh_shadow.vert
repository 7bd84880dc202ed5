// Meshes seen by the sun.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/mesh_vertex.glsl"

layout(location = 0) out vec2 uv;
layout(location = 1) out vec4 vertex_color;
layout(location = 2) flat out float handed;

void main() {
  MeshVertex v = mesh_vertex(uint(gl_VertexIndex), uint(gl_InstanceIndex));
  uv = v.uv;
  vertex_color = v.color;
  handed = v.handed;
  gl_Position = push.clip_from_local * vec4(v.position, 1.0);
}
