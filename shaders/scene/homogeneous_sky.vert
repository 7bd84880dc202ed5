// The sky mesh in Hoffman and Preetham's model. The distance of a vertex is the optical length of air in its direction.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/sky_mesh.glsl"
#include "scene/homogeneous_air.glsl"

layout(location = 0) out vec3 offset;  // from the eye
layout(location = 1) out vec3 vertex_extinction;
layout(location = 2) out vec3 vertex_inscattering;

void main() {
  vec3 direction = sky_mesh_direction(uint(gl_VertexIndex));
  float air_m;
  air_to(direction, true, vertex_extinction, vertex_inscattering, air_m);
  offset = direction * max(air_m, 1000.0);
  gl_Position = sky_mesh_clip(offset);
}
