// Terrain in O'Neil's model: single scattering from the eye to every vertex.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_vertex.glsl"
#include "scene/oneil_air.glsl"

layout(location = 0) out vec4 place;  // texel of the level, altitude [m], morph
layout(location = 1) flat out uint level_layer;
layout(location = 2) out vec3 vertex_rayleigh;
layout(location = 3) out vec3 vertex_mie;
layout(location = 4) out vec3 vertex_transmittance;

void main() {
  TerrainVertex v = terrain_vertex(uint(gl_VertexIndex), uint(gl_InstanceIndex));
  place = vec4(v.texel, v.altitude_m, v.morph);
  level_layer = v.layer;
  vec3 offset = v.position - eye_position;
  OneilLight light = oneil_light(normalize(offset), length(offset), kAtDistance);
  vertex_rayleigh = light.rayleigh;
  vertex_mie = light.mie;
  vertex_transmittance = light.transmittance;
  gl_Position = push.clip_from_local * vec4(v.position, 1.0);
}
