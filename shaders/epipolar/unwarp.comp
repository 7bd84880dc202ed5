// Composes the picture in blocks of 4 x 2 pixels, or 2 x 2 on GPUs. If all pixels of a block are at one depth, they are
// blended from the same four samples. The other blocks are listed for unwarp_pixels.comp. Every pixel is read and
// written once. With kDownscale, the output is the half- or quarter-resolution buffer, which stores mean source
// functions instead of radiance (Yusov 2012, section 6.6).
#version 460
#extension GL_GOOGLE_include_directive : require

#define UNIFORM_CONSTANTS

#include "epipolar/block.glsl"
#include "epipolar/downscaled.glsl"
#include "epipolar/store_downscaled.glsl"
#include "epipolar/unwarp.glsl"
#include "frame/output.glsl"
#include "frame/picture.glsl"

BLOCK_GROUP;

// With more samples per pixel, a block on the ground extends too far beyond its four samples.
const float kMaxSamplesPerPixel = 0.75;
// Invisible relative error of the square root of radiance in the sky: a quarter of a step of an 8-bit display.
const float kInvisibleError = 0.002;
// The pixels of a block are at one depth if they differ by less than this, in units of the threshold of refinement.
// Buffer pixels are farther apart than pixels, and upscaling compares depths again.
const float kOneDepth = kDownscale == 1 ? 1.0 : 3.0;

// Returns the largest distance of the pixels of a block from its middle, in units of the distance between samples or
// between slices, whichever gives more.
float reach_in_samples(Around a, vec2 middle) {
  vec2 reach = 0.5 * float(kDownscale) * vec2(float(kBlockWidth - 1), 1.0);
  float along = max(dot(abs(a.origin_lower.zw), reach), dot(abs(a.origin_upper.zw), reach));
  return max(along, slices_within(middle, a.side, reach));
}

// Mean extinction coefficients of the pixels' own rays: computed at three corners of a block, affine between them.
struct OwnExtinction {
  Spectrum corner;
  Spectrum per_x;  // change per pixel
  Spectrum per_y;
};

OwnExtinction own_extinction(Block block, bool scene) {
  const int kCorners[3] = int[3](0, kBlockWidth - 1, kBlockWidth);
  Spectrum extinction[3];
  for (int i = 0; i < 3; ++i) {
    int k = kCorners[i];
    Spectrum tau = own_optical_depth(vec2(block.pixel[k]) + 0.5, block.visible_m[k], block.sky[k]);
    extinction[i] = extinction_of(tau, scene ? block.visible_m[k] : kSkyDepth);
  }
  // The last block of a row may be narrower.
  float width = max(float(block.pixel[kBlockWidth - 1].x - block.pixel[0].x), 1.0);
  return OwnExtinction(extinction[0], (extinction[1] - extinction[0]) / width, extinction[2] - extinction[0]);
}

struct Attenuation {
  Spectrum tau;
  Spectrum transmittance;
  Spectrum opacity;
};

Attenuation attenuation_of(Spectrum tau) {
  Attenuation a;
  a.tau = tau;
  attenuation(tau, a.transmittance, a.opacity);
  return a;
}

// Returns the attenuation at another optical depth, by a series of fourth order in the difference x. For use in blocks
// whose pixels have one depth and for which extinction_varies() is false, because x is small there. The error is below
// 0.003 even at the limb.
Attenuation attenuation_near(Attenuation a, Spectrum tau) {
  Spectrum x = tau - a.tau;
  Spectrum more = a.transmittance * x * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0))));
  return Attenuation(tau, a.transmittance - more, a.opacity + more);
}

const bool kBlockAttenuation = !kHomogeneous && kExtinction == Extinction_epipolar && kDownscale == 1;

void main() {
  ivec2 corner = ivec2(kBlockWidth, 2) * ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = computed_size();
  if (corner.x >= size.x || corner.y >= size.y) return;
  Block block;
  ivec2 place[kBlockPixels];
  for (int k = 0; k < kBlockPixels; ++k) {
    place[k] = min(corner + offset_in_block(k), size - 1);
    block.pixel[k] = kDownscale == 1 ? place[k] : pixel_of_downscaled(place[k]);
  }
  read_block(block);
  // The last pixels are repeated at an odd size, so the middle is always inside the picture.
  vec2 middle = 0.5 * vec2(block.pixel[0] + block.pixel[kBlockPixels - 1]) + 0.5;
  bool scene = block.kinds == kScene;
  float depth_m = scene ? 0.5 * (block.nearest_m + block.farthest_m) : kSkyDepth;
  bool one_depth = scene ? block.farthest_m - block.nearest_m < kOneDepth * epipolar.depth_tolerance * block.farthest_m
                         : block.kinds == kSky;
  Around a = around(middle, depth_m);
  // In twilight, the sum of weights varies within a block of the sky and is smallest next to the ground. The larger
  // minimum for its middle leaves room for that.
  float lowered = 0.8 * (epipolar.min_weight_sky - epipolar.min_weight);
  float min_weight = scene ? epipolar.min_weight : min(epipolar.min_weight_sky + lowered, 0.999);
  // Beyond kMaxExtrapolation the blend is constant. A block of the sky that extends farther would appear as a bar if
  // the in-scattering changes.
  float change = contrast(a);
  bool too_far = (reach_in_samples(a, middle) - kMaxExtrapolation) * change > kInvisibleError;
  bool dense = max(length(a.origin_lower.zw), length(a.origin_upper.zw)) * float(kDownscale) > kMaxSamplesPerPixel;
  dense = scene ? dense : too_far;
  // Next to the limb, extinction decreases so fast that linear extrapolation soon reaches zero.
  dense = dense || extinction_varies(a);
  float weight = blend(a, middle).weight;
  bool doubtful = weight < min_weight || 2.0 * (1.0 - weight) * change > epipolar.tolerated_difference;
  if (!one_depth || dense || (kSkyline && !scene && depths_differ(a)) || doubtful) {
    list_block(corner);
    return;
  }
  bool own = kSparse && kExtinction == Extinction_epipolar && (!scene || depths_differ(a));
  OwnExtinction extinction;
  if (own) extinction = own_extinction(block, scene);
  // The outermost pixels of both rows are blended. The square roots of the pixels between are interpolated linearly.
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
    Spectrum root = 0.25 * (left[0].extinction + right[0].extinction + left[1].extinction + right[1].extinction);
    Spectrum of_middle = root * root;
    if (own)
      of_middle = max(extinction.corner + 0.5 * (extinction.per_x / per_pixel + extinction.per_y), Spectrum(0.0));
    middle_of_block = attenuation_of(optical_depth_at(of_middle, depth_m));
  }
  for (int k = 0; k < kBlockPixels; ++k) {
    ivec2 pixel = block.pixel[k];
    float own_m = scene ? block.visible_m[k] : depth_m;
    vec2 off = vec2(pixel - block.pixel[0]);
    Blend b;
    b.source = mix(left[k / kBlockWidth].source, right[k / kBlockWidth].source, off.x * per_pixel);
    b.extinction = mix(left[k / kBlockWidth].extinction, right[k / kBlockWidth].extinction, off.x * per_pixel);
    b.source *= b.source;
    b.extinction *= b.extinction;
    if (own) b.extinction = max(extinction.corner + off.x * extinction.per_x + off.y * extinction.per_y, Spectrum(0.0));
    if (kDownscale > 1) {
      store_downscaled(place[k], own_m, b.source, b.extinction);
      continue;
    }
    vec3 background = load_color(pixel);
    vec3 color;
    if (kBlockAttenuation) {
      Attenuation here = attenuation_near(middle_of_block, optical_depth_at(b.extinction, own_m));
      color = compose(b.source, here.transmittance, here.opacity, background);
    } else {
      color = compose(b, vec2(pixel) + 0.5, own_m, block.visible_m[k], block.sky[k], background);
    }
    store_color(pixel, color);
  }
}
