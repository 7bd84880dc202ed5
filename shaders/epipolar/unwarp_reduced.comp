// scattering.downscale: from slices to the reduced picture. Each of its pixels is one of the picture's, that in the middle
// of a block; its record holds the source, not the light, and the depth that goes with it (Yusov 2012, section 6.6).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"

layout(local_size_x = 64) in;  // along rows, as images lie in memory

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer frame_block { FrameConstants frame; };
layout(std430, binding = 2) readonly buffer epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 3) readonly buffer slice_block { EpipolarSlice slices[]; };
layout(std430, binding = 4) readonly buffer sample_block { uvec4 samples[]; };
layout(binding = 5) uniform sampler2D scene_depth;
layout(std430, binding = 6) writeonly buffer reduced_block { uvec4 reduced[]; };
layout(std430, binding = 7) buffer break_list_block { WorkList breaks; uint break_list[]; };

#include "epipolar/unwarp.glsl"
#include "epipolar/work_list.glsl"
#include "epipolar/reduced.glsl"

void main() {
  uvec2 at = gl_GlobalInvocationID.xy;
  if (at.x >= epipolar.reduced_width || at.y >= epipolar.reduced_height) return;
  ivec2 pixel = pixel_of_reduced(at);
  vec2 position = vec2(pixel) + 0.5;
  float depth = texelFetch(scene_depth, pixel, 0).r;
  Sample s;
  s.depth_m = depth == frame.sky_depth ? sky_depth_m(ray_direction(frame, position)) : view_depth(frame, position, depth);
  Blend b = blend(around(position, s.depth_m), position);
  s.source = b.source;
  s.density = b.density;
  reduced[reduced_index(at)] = pack_sample(s);
  if (b.weight < kLeastWeight) {
    uint slot = atomicAdd(breaks.count, 1u);
    break_list[slot] = uint(pixel.y) << 16u | uint(pixel.x);
    uint groups = slot / kMarchGroup + 1u;
    atomicMax(breaks.groups_x, groups_along_x(groups));
    atomicMax(breaks.groups_y, groups_along_y(groups));
  }
}
