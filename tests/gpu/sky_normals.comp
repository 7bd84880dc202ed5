// Evaluates tyndall/sky_probe.glsl as a shader of an engine does: the irradiance of the given normals from the
// coefficients, in a uniform block.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "tyndall/sky_probe.glsl"

layout(local_size_x = 32) in;

layout(std140, binding = 0) uniform sky_block { vec4 sky_coefficients[9]; };
layout(std430, binding = 1) readonly buffer normal_block { vec4 normals[]; };
layout(std430, binding = 2) writeonly buffer result_block { vec4 results[]; };

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= uint(normals.length())) return;
  results[index] = vec4(tyndall_sky_irradiance(sky_coefficients, normals[index].xyz), 0.0);
}
