// Builds the trees of all rows: a group makes the nodes of one block of 256 cells.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"

layout(local_size_x = 32) in;
layout(constant_id = 0) const uint kFormat = 0u;  // MinMaxFormat

layout(std430, binding = 0) readonly buffer frame_block { FrameConstants frame; };
layout(std430, binding = 1) readonly buffer epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 2) readonly buffer row_block { ShadowRow rows[]; };
layout(std430, binding = 3) writeonly buffer tree_block { uint tree[]; };
layout(binding = 4) uniform sampler2DArray shadow_depths;

layout(std430, binding = 5) readonly buffer work_block { WorkList work; uint items[]; };  // row << 8 | block

#include "epipolar/shadow_tree.glsl"

const uint kCells = 8u;  // of a thread
const float kAlwaysLit = 1e30;

shared vec2 thread_nodes[32];

// Least and greatest slope of what the comparison in the middle of cell x can meet, a little outwards.
vec2 cell_slopes(ShadowRow row, int x, uint cascade) {
  vec2 uv = vec2(row.u, row.v) + (float(x) + 0.5) * vec2(row.du, row.dv);
  vec4 depths = textureGather(shadow_depths, vec3(uv, float(cascade)));
  if (frame.shadow_depth_reversed != 0u) depths = 1.0 - depths;
  float camera = frame.shadow_depth_reversed != 0u ? 1.0 - row.depth : row.depth;
  vec2 least_most = vec2(min(min(depths.x, depths.y), min(depths.z, depths.w)),
                         max(max(depths.x, depths.y), max(depths.z, depths.w)));
  // Rounding of the ray's depth, which is the sum of the camera's and that of the way.
  float slack = 4e-7 * (1.0 + abs(camera));
  vec2 rise = vec2(least_most.x - slack, least_most.y + slack) - camera;
  // A ray may be compared anywhere within the cell: the slope that is safe is that to its nearer or farther end.
  vec2 ends = vec2(max(float(x), 1e-9), float(x) + 1.0);
  float low = rise.x / (rise.x >= 0.0 ? ends.y : ends.x);
  float high = rise.y / (rise.y >= 0.0 ? ends.x : ends.y);
  // Where nothing casts a shadow, nothing is dark however deep.
  return vec2(least_most.x >= 1.0 ? kAlwaysLit : low, least_most.y >= 1.0 ? kAlwaysLit : high);
}

vec2 rounded_numbers(vec2 slopes) {
  float resolution = float(frame.shadow_resolution);
  vec2 n = vec2(tree_number(slopes.x, resolution, kFormat), tree_number(slopes.y, resolution, kFormat));
  if (kFormat == kUnorm16) {
    n = clamp(vec2(floor(n.x - 0.02), ceil(n.y + 0.02)), vec2(0.0), vec2(65535.0));
    return vec2(slopes.x >= kAlwaysLit ? 65535.0 : n.x, n.y);
  }
  return vec2(slopes.x >= kAlwaysLit ? 2.0 : n.x - 2e-7, n.y + 2e-7);
}

void store_node(uint at, vec2 n) {
  if (kFormat == kUnorm16) {
    tree[at] = uint(n.x) | uint(n.y) << 16u;
  } else {
    tree[2u * at] = floatBitsToUint(n.x);
    tree[2u * at + 1u] = floatBitsToUint(n.y);
  }
}

vec2 both(vec2 a, vec2 b) { return vec2(min(a.x, b.x), max(a.y, b.y)); }

void build_block(uint id, uint block) {
  ShadowRow row = rows[id];
  uint cascade = epipolar.first_cascade + id / epipolar.slices;
  uint thread = gl_LocalInvocationID.x;
  uint base = (id * (epipolar.tree_cells / kTreeBlock) + block) * kTreeNodes16;

  uint first = thread * kCells;
  // Behind the row's end nothing is shadowed.
  vec2 neutral = rounded_numbers(vec2(kAlwaysLit));
  vec2 pair, four, eight;
  for (uint k = 0u; k < kCells; ++k) {
    uint cell = first + k;
    int j = int(block * kTreeBlock + cell);
    vec2 n = rounded_numbers(cell_slopes(row, row.first + j, cascade));
    n = j < row.count ? n : neutral;
    store_node(base + node_index(cell, 0u), n);
    pair = (k & 1u) == 0u ? n : both(pair, n);
    if ((k & 1u) == 1u) {
      store_node(base + node_index(cell, 1u), pair);
      four = (k & 2u) == 0u ? pair : both(four, pair);
    }
    if ((k & 3u) == 3u) {
      store_node(base + node_index(cell, 2u), four);
      eight = (k & 4u) == 0u ? four : both(eight, four);
    }
  }
  store_node(base + node_index(first, 3u), eight);
  thread_nodes[thread] = eight;
  barrier();
  // The levels above, each node by itself: 16 of 16 cells, 8 of 32, 4 of 64, 2 of 128, 1 of 256.
  uint level = thread < 16u ? 4u : thread < 24u ? 5u : thread < 28u ? 6u : thread < 30u ? 7u : 8u;
  uint index = thread - (32u - (32u >> (level - 4u)));
  if (thread < 31u) {
    uint span = 1u << (level - 3u);
    vec2 n = thread_nodes[index * span];
    for (uint k = 1u; k < span; ++k) n = both(n, thread_nodes[index * span + k]);
    store_node(base + node_index(index << level, level), n);
  }
}

void main() {
  for (uint at = gl_WorkGroupID.x; at < work.count; at += gl_NumWorkGroups.x) {
    build_block(items[at] >> 8u, items[at] & 0xFFu);
    barrier();
  }
}
