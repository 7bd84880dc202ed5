// Blocks of kBlockWidth x 2 pixels: their depths, and the list of blocks whose pixels are composed one by one. The list
// stores squares of 2 x 2 pixels. A shader whose blocks differ from those of unwarp.comp defines BLOCK_WIDTH before its
// first include.
#ifndef TYNDALL_BLOCK_GLSL
#define TYNDALL_BLOCK_GLSL

#include "epipolar/downscaled.glsl"
#include "epipolar/unwarp.glsl"
#include "epipolar/work_list.glsl"
#include "frame/picture.glsl"

#ifndef BLOCK_WIDTH
#ifdef TARGET_GPU
#define BLOCK_WIDTH kUnwarpWidthGpu
#else
#define BLOCK_WIDTH kUnwarpWidthCpu
#endif
#endif

// The workgroup of a pass over blocks. On GPUs it is a square, so that its writes fill whole sectors of the cache. On
// CPU devices it is a row, because they store images row by row.
#ifdef TARGET_GPU
#define BLOCK_GROUP layout(local_size_x = 8, local_size_y = 8) in
#else
#define BLOCK_GROUP layout(local_size_x = 64) in
#endif
const int kBlockWidth = int(BLOCK_WIDTH);

layout(std430, binding = 18) buffer discontinuity_blocks_block {
  WorkList discontinuities;
  uint discontinuity_blocks[];
};

// The contents of pixels, as bits.
const uint kScene = 1u;
const uint kPlanet = 2u;  // nothing was drawn, and the ray hits the planet
const uint kSky = 4u;

const int kBlockPixels = 2 * kBlockWidth;

// Returns the offset of pixel k from the corner of its block.
ivec2 offset_in_block(int k) { return ivec2(k % kBlockWidth, k / kBlockWidth); }

struct Block {
  ivec2 pixel[kBlockPixels];
  float visible_m[kBlockPixels];
  bool sky[kBlockPixels];
  uint kinds;        // kScene, kPlanet and kSky, as far as any pixel has them
  float nearest_m;   // minimum depth of the pixels that show the scene
  float farthest_m;  // maximum depth of these pixels
};

bool below_horizon(ivec2 pixel) {
  vec2 position = vec2(pixel) + 0.5;
  vec3 direction = frame.ray_origin + position.x * frame.ray_x + position.y * frame.ray_y;
  return dot(direction, frame.camera_up) < frame.horizon_cos * length(direction);
}

// Adds pixel k, at a device depth. `planet`: its ray hits the planet if nothing was drawn.
void add_pixel(inout Block block, int k, float depth, bool planet) {
  vec2 position = vec2(block.pixel[k]) + 0.5;
  bool sky = depth == frame.sky_depth;
  float visible_m = view_depth(frame, position, depth);
  block.sky[k] = sky;
  block.visible_m[k] = visible_m;
  block.kinds |= !sky ? kScene : planet ? kPlanet : kSky;
  block.nearest_m = sky ? block.nearest_m : min(block.nearest_m, visible_m);
  block.farthest_m = sky ? block.farthest_m : max(block.farthest_m, visible_m);
}

// Reads the depths of a block and fills in everything except `pixel`, which the caller has set.
void read_block(inout Block block) {
  block.kinds = 0u;
  block.nearest_m = kSkyDepth;
  block.farthest_m = 0.0;
  float depth[kBlockPixels];
  if (kDownscale == 1) {
    // A gather returns a square of 2 x 2 depths.
    for (int k = 0; k < kBlockWidth; k += 2) {
      vec4 d = gather_depth(block.pixel[0] + ivec2(k, 0));
      depth[k] = d.w;
      depth[k + 1] = d.z;
      depth[kBlockWidth + k] = d.x;
      depth[kBlockWidth + k + 1] = d.y;
    }
    // In a block that extends beyond the picture, the last pixels inside are repeated.
    ivec2 inside = ivec2(frame.width, frame.height) - block.pixel[0];
    for (int k = 1; k < kBlockWidth; ++k) {
      depth[k] = k < inside.x ? depth[k] : depth[k - 1];
      depth[kBlockWidth + k] = k < inside.x ? depth[kBlockWidth + k] : depth[kBlockWidth + k - 1];
    }
    for (int k = 0; k < kBlockWidth; ++k) depth[kBlockWidth + k] = inside.y > 1 ? depth[kBlockWidth + k] : depth[k];
  } else {
    for (int k = 0; k < kBlockPixels; ++k) depth[k] = load_depth(block.pixel[k]);
  }
  // The horizon is straight within a block, so testing both ends of a row is enough.
  for (int row = 0; row < 2; ++row) {
    int first = row * kBlockWidth;
    bool left = below_horizon(block.pixel[first]);
    bool right = below_horizon(block.pixel[first + kBlockWidth - 1]);
    for (int i = 0; i < kBlockWidth; ++i) {
      add_pixel(block, first + i, depth[first + i], 2 * i < kBlockWidth ? left : right);
    }
  }
}

// Adds a block to the list.
void list_block(ivec2 corner) {
  const uint squares = uint(kBlockWidth) / 2u;
  uint at, end;
  bool leads;
  RESERVE(discontinuities, squares, at, end, leads)
  for (uint i = 0u; i < squares; ++i) discontinuity_blocks[at + i] = uint(corner.y) << 16u | (uint(corner.x) + 2u * i);
  if (!leads) return;
  uint groups = (4u * end + kMarchGroup - 1u) / kMarchGroup;
  atomicMax(discontinuities.groups_x, groups_along_x(groups));
  atomicMax(discontinuities.groups_y, groups_along_y(groups));
}

#endif
