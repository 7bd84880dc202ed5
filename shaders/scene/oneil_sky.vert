// The sky mesh in O'Neil's model: single scattering along the ray through each vertex, out of the atmosphere or, below
// the horizon, to the planet's sphere.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/sky_mesh.glsl"
#include "scene/oneil_air.glsl"

layout(location = 0) out vec3 offset;  // from the eye
layout(location = 1) out vec3 vertex_rayleigh;
layout(location = 2) out vec3 vertex_mie;
layout(location = 3) out vec3 vertex_transmittance;

void main() {
  offset = sky_mesh_direction(uint(gl_VertexIndex)) * 1000.0;
  vertex_rayleigh = vec3(0.0);
  vertex_mie = vec3(0.0);
  vertex_transmittance = vec3(1.0);
  if (kPerPixel == 0u) {
    // The mesh has one row on the horizon and one just below it, so that the edge there stays sharp.
    float zenith = sky_mesh_zenith(uint(gl_VertexIndex));
    OneilLight light = oneil_light(normalize(offset), 0.0, zenith > horizon_rad + 2.0e-5 ? kAtGround : kInSpace);
    vertex_rayleigh = light.rayleigh;
    vertex_mie = light.mie;
    vertex_transmittance = light.transmittance;
  }
  gl_Position = sky_mesh_clip(offset);
}
