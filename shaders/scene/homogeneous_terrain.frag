// Writes the visible ground point and the interpolated vertex results; homogeneous_light.comp combines them.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_point.glsl"

layout(location = 0) in vec4 place;
layout(location = 1) flat in uint level_layer;
layout(location = 2) in vec3 vertex_extinction;
layout(location = 3) in vec3 vertex_inscattering;
layout(location = 0) out vec4 point;
layout(location = 1) out vec4 extinction;
layout(location = 2) out vec4 inscattering;

void main() {
  point = pack_ground_point(place.xy, place.z, level_layer, place.w);
  extinction = vec4(vertex_extinction, 0.0);
  inscattering = vec4(vertex_inscattering, 0.0);
}
