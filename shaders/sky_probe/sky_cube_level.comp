// Computes a level of the radiance of a sky probe's cube map from the one before: means of four texels, weighted by
// their solid angles. One invocation per texel. push: the index of the texel in its level; the level.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/tables.h"
#include "shared/sky_probe.h"
#include "sky_probe/sky_cube.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = 1) readonly buffer sky_probe_block { SkyProbeConstants probe; };
layout(std430, binding = 2) buffer sky_cube_radiance_block { vec4 radiance[]; };
layout(push_constant) uniform Push {
  uint first;
  uint level;
};

void main() {
  uint index = first + gl_GlobalInvocationID.x;
  uint width = probe.cube_size >> level;
  if (index >= 6u * width * width) return;
  uint row = index / width;  // of all faces
  uint finer = level_start(probe.cube_size, level - 1u) + 4u * row * width + 2u * (index % width);
  vec4 sum = vec4(0.0);
  for (uint i = 0u; i < 4u; ++i) {
    vec4 texel = radiance[finer + (i & 1u) + (i >> 1u) * 2u * width];
    sum += vec4(texel.rgb * texel.a, texel.a);
  }
  radiance[level_start(probe.cube_size, level) + index] = vec4(sum.rgb / sum.a, sum.a);
}
