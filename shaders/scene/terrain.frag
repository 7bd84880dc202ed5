// Writes the visible ground point; terrain_light.comp lights it. Triangles are about as small as pixels, and a device
// shades at least four pixels of each (a CPU device sixteen), so this shader must be cheap.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_point.glsl"

layout(location = 0) in vec4 place;
layout(location = 1) flat in uint level_layer;
layout(location = 0) out vec4 point;

void main() { point = pack_ground_point(place.xy, place.z, level_layer, place.w); }
