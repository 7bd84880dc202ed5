// Terrain seen by the camera.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_vertex.glsl"

layout(location = 0) out vec4 place;  // texel of the level, altitude [m], morph
layout(location = 1) flat out uint level_layer;

void main() {
  TerrainVertex v = terrain_vertex(uint(gl_VertexIndex), uint(gl_InstanceIndex));
  place = vec4(v.texel, v.altitude_m, v.morph);
  level_layer = v.layer;
  gl_Position = push.clip_from_local * vec4(v.position, 1.0);
}
