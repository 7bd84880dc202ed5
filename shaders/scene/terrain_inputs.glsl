// What the vertices of the ground hand to a fragment that lights it at once: scene/terrain_ground.glsl for the models of
// the sky, whose air is known at vertices.
#ifndef TYNDALL_TERRAIN_INPUTS_GLSL
#define TYNDALL_TERRAIN_INPUTS_GLSL

#include "scene/terrain_ground.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 map_altitude;  // map x, map z, altitude [m]
layout(location = 2) in vec4 texels;        // in the level's texture and in its parent's
layout(location = 3) in float level_morph;
layout(location = 4) flat in uint level_layer;

vec3 ground_radiance() {
  return ground_radiance(GroundPoint(world_position, map_altitude.xy, map_altitude.z, texels.xy, texels.zw, level_morph,
                                     level_layer));
}

#endif
