// Terrain in Hoffman and Preetham's model: transmittance and in-scattering at every vertex.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_vertex.glsl"
#include "scene/homogeneous_air.glsl"

layout(location = 0) out vec4 place;  // texel of the level, altitude [m], morph
layout(location = 1) flat out uint level_layer;
layout(location = 2) out vec3 vertex_extinction;
layout(location = 3) out vec3 vertex_inscattering;

void main() {
  TerrainVertex v = terrain_vertex(uint(gl_VertexIndex), uint(gl_InstanceIndex));
  place = vec4(v.texel, v.altitude_m, v.morph);
  level_layer = v.layer;
  float air_m;
  air_to(v.position - eye_position, false, vertex_extinction, vertex_inscattering, air_m);
  gl_Position = push.clip_from_local * vec4(v.position, 1.0);
}
