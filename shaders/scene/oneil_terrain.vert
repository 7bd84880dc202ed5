// Terrain in O'Neil's air: the integral from the eye to every vertex.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_vertex.glsl"
#include "scene/oneil_air.glsl"

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 map_altitude;      // map x, map z, altitude [m]
layout(location = 2) out vec4 texels;            // in the level's texture and in its parent's
layout(location = 3) out float level_morph;
layout(location = 4) flat out uint level_layer;
layout(location = 5) out vec3 vertex_rayleigh;
layout(location = 6) out vec3 vertex_mie;
layout(location = 7) out vec3 vertex_through;

void main() {
  TerrainVertex v = terrain_vertex(uint(gl_VertexIndex), uint(gl_InstanceIndex));
  world_position = v.position;
  map_altitude = vec3(v.map_m, v.altitude_m);
  texels = vec4(v.texel, v.parent_texel);
  level_morph = v.morph;
  level_layer = v.layer;
  vertex_rayleigh = vec3(0.0);
  vertex_mie = vec3(0.0);
  vertex_through = vec3(1.0);
  if (kPerPixel == 0u) {
    vec3 offset = v.position - eye_position;
    oneil_air(normalize(offset), length(offset), kAtDistance, vertex_rayleigh, vertex_mie, vertex_through);
  }
  gl_Position = push.clip_from_world * vec4(v.position, 1.0);
}
