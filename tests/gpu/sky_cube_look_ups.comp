// Looks up the cube map of a sky probe as a shader of an engine does: reflections in directions with a roughness in w.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "tyndall/sky_probe.glsl"

layout(local_size_x = 32) in;

layout(binding = 0) uniform samplerCube sky_cube;
layout(std430, binding = 1) readonly buffer query_block { vec4 queries[]; };
layout(std430, binding = 2) writeonly buffer result_block { vec4 results[]; };

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= uint(queries.length())) return;
  vec4 q = queries[index];
  results[index] = vec4(tyndall_sky_reflection(sky_cube, q.xyz, q.w), 0.0);
}
