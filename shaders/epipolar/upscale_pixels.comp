// The pixels that no reduced one fits, from the slices themselves; those that no sample fits either are listed again.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"

layout(local_size_x = kMarchGroup) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer frame_block { FrameConstants frame; };
layout(std430, binding = 2) readonly buffer epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 3) readonly buffer slice_block { EpipolarSlice slices[]; };
layout(std430, binding = 4) readonly buffer sample_block { uvec4 samples[]; };
layout(binding = 5) uniform sampler2D scene_color;
layout(binding = 6) uniform sampler2D scene_depth;
layout(binding = 7, OUTPUT_FORMAT) uniform writeonly image2D output_color;
layout(std430, binding = 8) readonly buffer work_block { WorkList work; uint items[]; };
layout(std430, binding = 9) buffer break_list_block { WorkList breaks; uint break_list[]; };

#include "epipolar/unwarp.glsl"
#include "epipolar/work_list.glsl"

void upscale_pixel(uint item) {
  ivec2 pixel = ivec2(item & 0xFFFFu, item >> 16u);
  vec2 position = vec2(pixel) + 0.5;
  float depth = texelFetch(scene_depth, pixel, 0).r;
  bool sky = depth == frame.sky_depth;
  float visible_m = view_depth(frame, position, depth);
  float depth_m = sky ? sky_depth_m(ray_direction(frame, position)) : visible_m;
  Blend b = blend(around(position, depth_m), position);
  vec3 background = texelFetch(scene_color, pixel, 0).rgb;
  imageStore(output_color, pixel, vec4(compose(b, position, depth_m, visible_m, sky, background), 1.0));
  if (b.weight < kLeastWeight) {
    uint slot = atomicAdd(breaks.count, 1u);
    break_list[slot] = item;
    uint groups = slot / kMarchGroup + 1u;
    atomicMax(breaks.groups_x, groups_along_x(groups));
    atomicMax(breaks.groups_y, groups_along_y(groups));
  }
}

void main() {
  uint at = list_item(kMarchGroup);
  if (at < work.count) upscale_pixel(items[at]);
}
