// Meshes seen by the camera.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/mesh_vertex.glsl"

layout(location = 0) out vec3 local_position;
layout(location = 1) out vec3 local_normal;
layout(location = 2) out vec2 uv;
layout(location = 3) out vec4 vertex_color;
layout(location = 4) flat out float handed;

void main() {
  MeshVertex v = mesh_vertex(uint(gl_VertexIndex), uint(gl_InstanceIndex));
  local_position = v.position;
  local_normal = v.normal;
  uv = v.uv;
  vertex_color = v.color;
  handed = v.handed;
  gl_Position = push.clip_from_local * vec4(v.position, 1.0);
}
