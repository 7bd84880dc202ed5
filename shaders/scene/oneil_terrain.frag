// Writes the visible ground point and the interpolated vertex results; oneil_light.comp combines them.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_point.glsl"

layout(location = 0) in vec4 place;
layout(location = 1) flat in uint level_layer;
layout(location = 2) in vec3 vertex_rayleigh;
layout(location = 3) in vec3 vertex_mie;
layout(location = 4) in vec3 vertex_transmittance;
layout(location = 0) out vec4 point;
layout(location = 1) out vec4 rayleigh;
layout(location = 2) out vec4 mie;
layout(location = 3) out vec4 transmittance;

void main() {
  point = pack_ground_point(place.xy, place.z, level_layer, place.w);
  rayleigh = vec4(vertex_rayleigh, 0.0);
  mie = vec4(vertex_mie, 0.0);
  transmittance = vec4(vertex_transmittance, 0.0);
}
