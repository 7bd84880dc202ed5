// With scattering.downscale, composes the pixels of blocks at a depth discontinuity. Each uses the buffer pixels at its
// depth, or the slices if there is none. Pixels that fit no sample are listed.
#version 460
#extension GL_GOOGLE_include_directive : require

#define UNIFORM_CONSTANTS

#include "epipolar/correction_list.glsl"
#include "epipolar/downscaled_around.glsl"
#include "epipolar/unwarp.glsl"
#include "frame/output.glsl"
#include "frame/picture.glsl"

layout(local_size_x = kMarchGroup) in;

layout(std430, binding = 16) readonly buffer work_block {
  WorkList work;
  uint items[];
};

// A pixel with a smaller sum of weights is interpolated from the slices.
const float kMinUpscaledWeight = 0.1;

void upscale_pixel(uint block, uint k) {
  ivec2 pixel = ivec2((block & 0xFFFFu) + (k & 1u), (block >> 16u) + (k >> 1u));
  if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height)) return;
  vec2 position = vec2(pixel) + 0.5;
  float depth = load_depth(pixel);
  bool sky = depth == frame.sky_depth;
  float visible_m = view_depth(frame, position, depth);
  float depth_m = sky ? sky_depth_m(ray_direction(frame, position)) : visible_m;
  Sample near[4];
  vec2 part;
  downscaled_around(pixel, part, near);
  vec4 w = bilinear_weights(part);
  for (int i = 0; i < 4; ++i) w[i] *= depth_nearness(near[i].depth_m, depth_m);
  float sum = w.x + w.y + w.z + w.w;
  Blend b = blend_downscaled(near, w / max(sum, 1e-9));
  Blend of_slices = blend(around(position, depth_m), position);
  if (sum < kMinUpscaledWeight) b = of_slices;
  vec3 background = load_color(pixel);
  store_color(pixel, compose(b, position, depth_m, visible_m, sky, background));
  if (sum < kMinUpscaledWeight && b.weight < epipolar.min_weight) list_correction(pixel);
}

void main() {
  uint i = list_item(kMarchGroup);
  if (i < 4u * work.count) upscale_pixel(items[i / 4u], i % 4u);
}
