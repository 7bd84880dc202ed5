// Puts the picture together, in blocks of 2 x 2 pixels: where they are at one depth, all four are blended from
// the same samples. The others are left to unwarp_pixels.comp. Every pixel is read and written once.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"

layout(local_size_x = 64) in;  // along rows, as images lie in memory

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std140, binding = 1) uniform frame_block { FrameConstants frame; };
layout(std140, binding = 2) uniform epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 3) readonly buffer slice_block { EpipolarSlice slices[]; };
layout(std430, binding = 4) readonly buffer sample_block { uvec4 samples[]; };
layout(binding = 5) uniform sampler2D scene_color;
layout(binding = 6) uniform sampler2D scene_depth;
layout(binding = 7, OUTPUT_FORMAT) uniform writeonly image2D output_color;
layout(std430, binding = 8) buffer broken_list_block { WorkList broken; uint broken_list[]; };

#include "epipolar/unwarp.glsl"
#include "epipolar/work_list.glsl"

ivec2 pixel_of(ivec2 corner, int k) { return min(corner + ivec2(k & 1, k >> 1), ivec2(frame.width, frame.height) - 1); }

void main() {
  ivec2 corner = 2 * ivec2(gl_GlobalInvocationID.xy);
  if (corner.x >= int(frame.width) || corner.y >= int(frame.height)) return;
  // Depths of the four, and whether they see the sky, the planet where nothing was drawn, or the scene.
  float visible_m[4];
  bool sky[4];
  float nearest = kSkyDepth;
  float farthest = 0.0;
  uint kinds = 0u;
  float horizon = horizon_cos(frame.camera_altitude_m, medium.planet_radius_m);
  for (int k = 0; k < 4; ++k) {
    ivec2 pixel = pixel_of(corner, k);
    vec2 position = vec2(pixel) + 0.5;
    float depth = texelFetch(scene_depth, pixel, 0).r;
    sky[k] = depth == frame.sky_depth;
    visible_m[k] = view_depth(frame, position, depth);
    vec3 direction = frame.ray_origin + position.x * frame.ray_x + position.y * frame.ray_y;
    bool planet = dot(direction, frame.camera_up) < horizon * length(direction);
    kinds |= !sky[k] ? 1u : planet ? 2u : 4u;
    nearest = sky[k] ? nearest : min(nearest, visible_m[k]);
    farthest = sky[k] ? farthest : max(farthest, visible_m[k]);
  }
  // Not beyond the last pixels of an odd size: what is seen there is none of the four.
  vec2 middle = min(vec2(corner) + 1.0, vec2(float(frame.width), float(frame.height)) - 0.5);
  float depth_m = kinds == 1u ? 0.5 * (nearest + farthest) : kSkyDepth;
  bool one_depth = kinds == 1u ? farthest - nearest < epipolar.threshold * farthest : kinds == 4u;
  Around a = around(middle, depth_m);
  bool dense = max(length(a.origin_lower.zw), length(a.origin_upper.zw)) > kDense;
  // Beside the limb air thins out from sample to sample: what goes on in a line beyond them soon is none at all.
  vec3 least = min(min(a.density[0], a.density[1]), min(a.density[2], a.density[3]));
  vec3 most = max(max(a.density[0], a.density[1]), max(a.density[2], a.density[3]));
  dense = dense || any(greaterThan(most, kUneven * least));
  if (!one_depth || dense || (kBreaks && blend(a, middle).weight < kLeastWeight)) {
    uint at = atomicAdd(broken.count, 1u);
    broken_list[at] = uint(corner.y) << 16u | uint(corner.x);
    uint groups = (4u * at + 4u + kMarchGroup - 1u) / kMarchGroup;
    atomicMax(broken.groups_x, groups_along_x(groups));
    atomicMax(broken.groups_y, groups_along_y(groups));
    return;
  }
  for (int k = 0; k < 4; ++k) {
    ivec2 pixel = pixel_of(corner, k);
    float own_m = kinds == 1u ? visible_m[k] : depth_m;
    vec3 background = texelFetch(scene_color, pixel, 0).rgb;
    vec2 position = vec2(pixel) + 0.5;
    vec3 color = compose(blend(a, position), position, own_m, visible_m[k], sky[k], background);
    imageStore(output_color, pixel, vec4(color, 1.0));
  }
}
