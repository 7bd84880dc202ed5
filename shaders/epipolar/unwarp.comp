// Puts the picture together, in blocks of 4 x 2 pixels: where they are at one depth, all eight are blended from
// the same samples. The others are left to unwarp_pixels.comp. Every pixel is read and written once. With kDownscale it
// is the reduced picture, whose pixels hold the source, not the light (Yusov 2012, section 6.6).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"

layout(local_size_x = 64) in;  // along rows, as images lie in memory

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std140, binding = 1) uniform frame_block { FrameConstants frame; };
layout(std140, binding = 2) uniform epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 3) readonly buffer slices_block { EpipolarSlice slices[]; };
layout(std430, binding = 4) readonly buffer samples_block { uvec4 samples[]; };
layout(binding = 5) uniform sampler2D scene_color;
layout(binding = 6) uniform sampler2D scene_depth;
layout(binding = 7, OUTPUT_FORMAT) uniform writeonly image2D output_color;
layout(std430, binding = 8) buffer discontinuity_blocks_block {
  WorkList broken;
  uint broken_list[];
};

layout(std430, binding = 9) writeonly buffer downscaled_inscattering_block { vec4 reduced[]; };

#include "frame/picture.glsl"
#include "epipolar/unwarp.glsl"
#include "epipolar/reduced.glsl"
const int kBlockWidth = int(kUnwarpWidth);
#include "epipolar/block.glsl"

// Samples to a pixel from which on a block on the ground would reach too far beyond its samples.
const float kDense = 0.75;
// Relative error of the light's root in a block of the sky that is not seen: a quarter of a step of a display with 8
// bits.
const float kEven = 0.002;
// Thresholds of refinement within which the pixels of a block are at one depth. Those of the reduced picture are
// farther apart, and the whole one's pixels are at depths of their own again.
const float kOneDepth = kDownscale == 1 ? 1.0 : 3.0;

// How far the pixels of a block reach from its middle, as multiples of the distances between samples and between slices
// there; the greater of both.
float reach_in_samples(Around a, vec2 middle) {
  vec2 reach = 0.5 * float(kDownscale) * vec2(float(kBlockWidth - 1), 1.0);
  float along = max(dot(abs(a.origin_lower.zw), reach), dot(abs(a.origin_upper.zw), reach));
  return max(along, slices_within(middle, a.side, reach));
}

// Optical depth per metre of the pixels' own rays: that of three corners of a block, and affine between.
struct OwnDensity {
  vec3 corner;
  vec3 per_x;  // by the pixel
  vec3 per_y;
};

OwnDensity own_density(Block block, bool scene) {
  const int kCorners[3] = int[3](0, kBlockWidth - 1, kBlockWidth);
  vec3 density[3];
  for (int i = 0; i < 3; ++i) {
    int k = kCorners[i];
    vec3 tau = own_optical_depth(vec2(block.pixel[k]) + 0.5, block.visible_m[k], block.sky[k]);
    density[i] = density_of(tau, scene ? block.visible_m[k] : kSkyDepth);
  }
  // The last block of a row may be narrower.
  float width = max(float(block.pixel[kBlockWidth - 1].x - block.pixel[0].x), 1.0);
  return OwnDensity(density[0], (density[1] - density[0]) / width, density[2] - density[0]);
}

// What the air takes away on the way to the middle of a block.
struct Attenuation {
  vec3 tau;
  vec3 through;
  vec3 lost;
};

Attenuation attenuation_of(vec3 tau) {
  Attenuation a;
  a.tau = tau;
  attenuation(tau, a.through, a.lost);
  return a;
}

// The same for a pixel of the block: exp(-x) to the fourth order of the difference x of optical depths, which is
// small where the depths are alike and the densities are not uneven(). The error is below 0.003 even at the limb.
Attenuation attenuation_near(Attenuation a, vec3 tau) {
  vec3 x = tau - a.tau;
  vec3 more = a.through * x * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0))));
  return Attenuation(tau, a.through - more, a.lost + more);
}

vec3 compose(Blend b, Attenuation a, vec3 background) {
  vec3 color = b.source * a.lost * frame.sun_irradiance;
  return frame.only == 0u ? color + background * a.through : color;
}

const bool kBlockAttenuation = !kHomogeneous && kExtinction == 0u && kDownscale == 1;

void main() {
  ivec2 corner = ivec2(kBlockWidth, 2) * ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = computed_size();
  if (corner.x >= size.x || corner.y >= size.y) return;
  Block block;
  ivec2 place[kBlockPixels];
  for (int k = 0; k < kBlockPixels; ++k) {
    place[k] = min(corner + place_in_block(k), size - 1);
    block.pixel[k] = kDownscale == 1 ? place[k] : pixel_of_reduced(place[k]);
  }
  look_at_block(block);
  // Not beyond the last pixels of an odd size: what is seen there is none of these.
  vec2 middle = 0.5 * vec2(block.pixel[0] + block.pixel[kBlockPixels - 1]) + 0.5;
  bool scene = block.kinds == kScene;
  float depth_m = scene ? 0.5 * (block.nearest_m + block.farthest_m) : kSkyDepth;
  bool one_depth = scene ? block.farthest_m - block.nearest_m < kOneDepth * epipolar.threshold * block.farthest_m
                         : block.kinds == kSky;
  Around a = around(middle, depth_m);
  // In twilight the pixels of the sky need not be alike: those nearest to the ground have the smallest weights.
  float lowered = 0.8 * (epipolar.least_weight_sky - epipolar.least_weight);
  float least_weight = scene ? epipolar.least_weight : epipolar.least_weight_sky + lowered;
  // Beyond kBeyond the blend no longer follows the light: a block of the sky that reaches farther shows as a bar where
  // the light changes.
  bool too_far = (reach_in_samples(a, middle) - kBeyond) * contrast(a) > kEven;
  bool dense = max(length(a.origin_lower.zw), length(a.origin_upper.zw)) * float(kDownscale) > kDense;
  dense = scene ? dense : too_far;
  // Beside the limb air thins out from sample to sample: what goes on in a line beyond them soon is none at all.
  dense = dense || uneven(a);
  if (!one_depth || dense || (kSkyline && !scene && lopsided(a)) || blend(a, middle).weight < least_weight) {
    list_broken(corner);
    return;
  }
  bool own = kSparse && kExtinction == 0u && (!scene || lopsided(a));
  OwnDensity density;
  if (own) density = own_density(block, scene);
  // Blends of the outermost pixels of both rows. Those between change evenly, as roots.
  const int kRight = kBlockWidth - 1;
  Blend left[2], right[2];
  for (int row = 0; row < 2; ++row) {
    left[row] = blend_roots(a, vec2(block.pixel[row * kBlockWidth]) + 0.5);
    right[row] = blend_roots(a, vec2(block.pixel[row * kBlockWidth + kRight]) + 0.5);
  }
  // The last block of a row may be narrower.
  float per_pixel = 1.0 / max(float(block.pixel[kRight].x - block.pixel[0].x), 1.0);
  Attenuation middle_of_block;
  if (kBlockAttenuation) {
    vec3 root = 0.25 * (left[0].density + right[0].density + left[1].density + right[1].density);
    vec3 of_middle = root * root;
    if (own) of_middle = max(density.corner + 0.5 * (density.per_x / per_pixel + density.per_y), vec3(0.0));
    middle_of_block = attenuation_of(optical_depth_at(of_middle, depth_m));
  }
  for (int k = 0; k < kBlockPixels; ++k) {
    ivec2 pixel = block.pixel[k];
    float own_m = scene ? block.visible_m[k] : depth_m;
    vec2 off = vec2(pixel - block.pixel[0]);
    Blend b;
    b.source = mix(left[k / kBlockWidth].source, right[k / kBlockWidth].source, off.x * per_pixel);
    b.density = mix(left[k / kBlockWidth].density, right[k / kBlockWidth].density, off.x * per_pixel);
    b.source *= b.source;
    b.density *= b.density;
    if (own) b.density = max(density.corner + off.x * density.per_x + off.y * density.per_y, vec3(0.0));
    if (kDownscale > 1) {
      STORE_REDUCED(place[k], own_m, b);
      continue;
    }
    vec3 background = LOAD_COLOR(pixel);
    vec3 color;
    if (kBlockAttenuation) {
      color = compose(b, attenuation_near(middle_of_block, optical_depth_at(b.density, own_m)), background);
    } else {
      color = compose(b, vec2(pixel) + 0.5, own_m, block.visible_m[k], block.sky[k], background);
    }
    STORE_COLOR(pixel, color);
  }
}
