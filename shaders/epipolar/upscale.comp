// With scattering.downscale, upsamples the half- or quarter-resolution buffer to the full resolution and composes it
// with the background (Yusov 2012, section 6.8), in blocks of 2 x 2 pixels. If the block and the four buffer pixels
// around it are at one depth, these are weighted bilinearly. Other blocks are left to upscale_pixels.comp, which
// compares depths.
#version 460
#extension GL_GOOGLE_include_directive : require

#define UNIFORM_CONSTANTS
#define BLOCK_WIDTH 2

#include "epipolar/block.glsl"
#include "epipolar/downscaled_around.glsl"
#include "epipolar/unwarp.glsl"
#include "frame/output.glsl"
#include "frame/picture.glsl"

BLOCK_GROUP;

// Depths whose relative difference is at most this multiple of the refinement threshold belong to one sloping surface.
// On such a surface, buffer pixels are blended bilinearly, without the weights of depth_nearness().
const float kOneSlope = 8.0;

void main() {
  ivec2 corner = 2 * ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = ivec2(frame.width, frame.height);
  if (corner.x >= size.x || corner.y >= size.y) return;
  Block block;
  for (int k = 0; k < kBlockPixels; ++k) block.pixel[k] = min(corner + offset_in_block(k), size - 1);
  read_block(block);
  Sample near[4];
  vec2 part;
  downscaled_around(corner, part, near);
  bool scene = block.kinds == kScene;
  float nearest_m = block.nearest_m;
  float farthest_m = block.farthest_m;
  for (int k = 0; k < 4; ++k) {
    nearest_m = min(nearest_m, near[k].depth_m);
    farthest_m = max(farthest_m, near[k].depth_m);
  }
  bool one_depth = scene ? farthest_m - nearest_m <= kOneSlope * epipolar.threshold * nearest_m
                         : block.kinds == kSky && nearest_m >= kSkyDepth;
  if (!one_depth) {
    list_block(corner);
    return;
  }
  for (int k = 0; k < kBlockPixels; ++k) {
    ivec2 pixel = block.pixel[k];
    vec2 position = vec2(pixel) + 0.5;
    vec2 own_part = part + vec2(offset_in_block(k)) / float(kDownscale);
    vec3 background = load_color(pixel);
    float own_m = scene ? block.visible_m[k] : kSkyDepth;
    vec3 color = compose(blend_downscaled(near, bilinear_weights(own_part)), position, own_m, block.visible_m[k],
                         block.sky[k], background);
    store_color(pixel, color);
  }
}
