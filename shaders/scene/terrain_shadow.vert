// Terrain seen by the sun: depth only.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_vertex.glsl"

void main() {
  TerrainVertex v = terrain_vertex(uint(gl_VertexIndex), uint(gl_InstanceIndex));
  gl_Position = push.clip_from_local * vec4(v.position, 1.0);
}
