// Builds the 1D min/max trees of all slice lines. A thread builds the nodes of a part of a block, one leaf after the
// other. It loads its slice line once, and only the few nodes above the parts are combined across threads.
#version 460
#extension GL_GOOGLE_include_directive : require

#define COPY_CONSTANTS

#include "epipolar/constants.glsl"
#include "epipolar/min_max_tree.glsl"
#include "epipolar/work_list.glsl"
#include "shared/constant_ids.h"
#include "shared/params.glsl"

layout(constant_id = kTreePartId) const uint kPartLevel = 6u;  // level of a part's topmost node
const uint kParts = kTreeBlock >> kPartLevel;                  // parts per block

// kTreeGroup * kParts invocations
#ifdef TARGET_GPU
layout(local_size_x = 128) in;
#else
layout(local_size_x = 32) in;
#endif
layout(constant_id = kFormatId) const uint kFormat = MinMaxFormat_unorm16;

layout(std430, binding = 13) readonly buffer slice_lines_block { SliceLine slice_lines[]; };
layout(std430, binding = 14) writeonly buffer min_max_tree_block { uint tree[]; };
layout(binding = 15) uniform sampler2DArray shadow_depths;

layout(std430, binding = 16) readonly buffer work_block {
  WorkList work;
  uint items[];
};  // slice line << 8 | block

const uint kCells = 1u << kTreeLeafLevel;  // per leaf
const uint kPartLeaves = 1u << (kPartLevel - kTreeLeafLevel);
const float kAlwaysLit = 1e30;

shared vec2 part_nodes[kTreeGroup * kParts];

vec2 both(vec2 a, vec2 b) { return vec2(min(a.x, b.x), max(a.y, b.y)); }

// Returns the minimum and maximum depth that comparisons between the middles of cell x and the next can read.
vec2 pair_depths(SliceLine slice_line, int x, uint cascade) {
  vec4 a = textureGather(shadow_depths, vec3(middle_of_cell(slice_line.line, float(x)), float(cascade)));
  vec4 b = textureGather(shadow_depths, vec3(middle_of_cell(slice_line.line, float(x + 1)), float(cascade)));
  vec4 low = min(a, b);
  vec4 high = max(a, b);
  vec2 depths = vec2(min(min(low.x, low.y), min(low.z, low.w)), max(max(high.x, high.y), max(high.z, high.w)));
  return frame.shadow_depth_reversed != 0u ? vec2(1.0 - depths.y, 1.0 - depths.x) : depths;
}

// Returns the minimum and maximum slope of rays that may meet these depths between the start of cell x and the end of
// the next.
vec2 pair_slopes(vec2 depths, int x, float camera) {
  // The rounding error of the depth of the ray, which is the sum of the camera's depth and the change along the ray.
  float slack = 4e-7 * (1.0 + abs(camera));
  vec2 rise = vec2(depths.x - slack, depths.y + slack) - camera;
  // The conservative slope is that to the nearer or to the farther end.
  vec2 per_cell = 1.0 / vec2(max(float(x), 1e-9), float(x) + 2.0);
  float low = rise.x * (rise.x >= 0.0 ? per_cell.y : per_cell.x);
  float high = rise.y * (rise.y >= 0.0 ? per_cell.x : per_cell.y);
  // Without a caster there is no shadow at any depth.
  return vec2(depths.x >= 1.0 ? kAlwaysLit : low, depths.y >= 1.0 ? kAlwaysLit : high);
}

// Returns the numbers of a node, rounded outwards. A node must not decide a ray that a comparison would decide
// differently. With u = 2^-24, the numbers of node and ray differ from exact ones by the following errors. Vulkan
// allows an error of 5 u for a division. The slope of either is a quotient and a product, 6 u; the number of a slope y,
// y / (1 + |y|), changes by at most a quarter of that, and has an error of 8 u itself. Both together have 19 u
// or 1.2e-6, which is 0.04 of a step of unorm16.
vec2 rounded_numbers(vec2 slopes) {
  const float kSlack = 1.5e-6;
  const float kSlackSteps = 0.05;
  float resolution = float(frame.shadow_resolution);
  vec2 n = vec2(tree_number(slopes.x, resolution, kFormat), tree_number(slopes.y, resolution, kFormat));
  if (kFormat == kUnorm16) {
    n = clamp(vec2(floor(n.x - kSlackSteps), ceil(n.y + kSlackSteps)), vec2(0.0), vec2(65535.0));
    return vec2(slopes.x >= kAlwaysLit ? 65535.0 : n.x, n.y);
  }
  return vec2(slopes.x >= kAlwaysLit ? 2.0 : n.x - kSlack, n.y + kSlack);
}

void store_node(uint at, vec2 n) {
  if (kFormat == kUnorm16) {
    tree[at] = uint(n.x) | uint(n.y) << 16u;
  } else {
    tree[2u * at] = floatBitsToUint(n.x);
    tree[2u * at + 1u] = floatBitsToUint(n.y);
  }
}

// The neutral value of both().
vec2 no_cells() { return kFormat == kUnorm16 ? vec2(65535.0, 0.0) : vec2(2.0, -2.0); }

// Builds the nodes of a part of a block and returns the last of them.
vec2 build_part(uint base, SliceLine slice_line, uint cascade, uint block, uint part) {
  float camera = frame.shadow_depth_reversed != 0u ? 1.0 - slice_line.depth : slice_line.depth;
  vec2 first_half[kPartLevel - kTreeLeafLevel];  // the pending node of each level of children
  vec2 n = no_cells();
  for (uint leaf = 0u; leaf < kPartLeaves; ++leaf) {
    uint cell = (part << kPartLevel) + leaf * kCells;
    int from = int(block * kTreeBlock + cell);
    n = no_cells();
    if (from < slice_line.cells.z) {
      vec2 slopes = vec2(kAlwaysLit, -kAlwaysLit);
      for (int k = 0; k < int(kCells); k += 2) {
        int x = slice_line.cells.x + from + k;
        slopes = both(slopes, pair_slopes(pair_depths(slice_line, x, cascade), x, camera));
      }
      n = rounded_numbers(slopes);
    }
    store_node(base + node_index(cell, kTreeLeafLevel), n);
    for (uint k = 0u; k < kPartLevel - kTreeLeafLevel; ++k) {
      if ((leaf >> k & 1u) == 0u) {
        first_half[k] = n;
        break;
      }
      n = both(first_half[k], n);
      store_node(base + node_index(cell, kTreeLeafLevel + k + 1u), n);
    }
  }
  return n;
}

void main() {
  load_frame();
  load_epipolar();
  uint thread = gl_LocalInvocationIndex;
  uint part = thread % kParts;
  uint at = list_group() * kTreeGroup + thread / kParts;
  bool working = at < work.count;
  uint base = 0u;
  if (working) {
    uint line = items[at] >> 8u;
    uint block = items[at] & 0xFFu;
    base = (line * (epipolar.tree_cells / kTreeBlock) + block) * kTreeNodes;
    part_nodes[thread] =
        build_part(base, slice_lines[line], epipolar.first_cascade + line / epipolar.slices, block, part);
  }
  barrier();
  for (uint level = kPartLevel + 1u; level <= kTreeTopLevel; ++level) {
    uint parts = 1u << (level - kPartLevel);
    if (!working || part % parts != 0u) break;
    vec2 n = part_nodes[thread];
    for (uint k = 1u; k < parts; ++k) n = both(n, part_nodes[thread + k]);
    store_node(base + node_index(part << kPartLevel, level), n);
  }
}
