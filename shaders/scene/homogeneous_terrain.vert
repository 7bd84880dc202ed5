// Terrain in Hoffman and Preetham's air: extinction and in-scattering at every vertex.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_vertex.glsl"
#include "scene/homogeneous_air.glsl"

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 map_altitude;      // map x, map z, altitude [m]
layout(location = 2) out vec4 texels;            // in the level's texture and in its parent's
layout(location = 3) out float level_morph;
layout(location = 4) flat out uint level_layer;
layout(location = 5) out vec3 vertex_extinction;
layout(location = 6) out vec3 vertex_inscattering;

void main() {
  TerrainVertex v = terrain_vertex(uint(gl_VertexIndex), uint(gl_InstanceIndex));
  world_position = v.position;
  map_altitude = vec3(v.map_m, v.altitude_m);
  texels = vec4(v.texel, v.parent_texel);
  level_morph = v.morph;
  level_layer = v.layer;
  vertex_extinction = vec3(1.0);
  vertex_inscattering = vec3(0.0);
  if (kPerPixel == 0u) {
    float air_m;
    air_to(v.position - eye_position, false, vertex_extinction, vertex_inscattering, air_m);
  }
  gl_Position = push.clip_from_world * vec4(v.position, 1.0);
}
