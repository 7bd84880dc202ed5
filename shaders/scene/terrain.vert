// Terrain as the camera sees it.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_vertex.glsl"

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 map_altitude;      // map x, map z, altitude [m]
layout(location = 2) out vec4 texels;            // in the level's texture and in its parent's
layout(location = 3) out float level_morph;
layout(location = 4) flat out uint level_layer;

void main() {
  TerrainVertex v = terrain_vertex(uint(gl_VertexIndex), uint(gl_InstanceIndex));
  world_position = v.position;
  map_altitude = vec3(v.map_m, v.altitude_m);
  texels = vec4(v.texel, v.parent_texel);
  level_morph = v.morph;
  level_layer = v.layer;
  gl_Position = push.clip_from_world * vec4(v.position, 1.0);
}
