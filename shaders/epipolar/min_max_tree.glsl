// A tree of the shadow casters along a slice line (Yusov 2013, section 1.5). It stores slopes instead of depths, after
// Chen, Baran, Durand and Jarosz, "Real-Time Volumetric Shadows using 1D Min-Max Mipmaps", 2011. All rays of a slice
// begin at the camera. A caster of depth d in cell x meets the rays that change depth by more than (d - camera's) / x
// per cell. A ray has one slope, so a node classifies every ray: lit below its minimum slope, in shadow above its
// maximum, undecided in between. The stored numbers are steps of y / (1 + |y|), which maps all slopes to [-1; 1]
// monotonically.
#ifndef TYNDALL_MIN_MAX_TREE_GLSL
#define TYNDALL_MIN_MAX_TREE_GLSL

#include "shared/params.glsl"

const uint kUnorm16 = MinMaxFormat_unorm16;
const uint kFloat32 = MinMaxFormat_float32;

// Returns the texture coordinates of the middle of a cell. The tree and the comparisons of rays read the same texels
// only if they are equal bit by bit in all pipelines.
vec2 middle_of_cell(vec4 line, float cell) {
  precise vec2 uv = line.xy + (cell + 0.5) * line.zw;
  return uv;
}

// Maps a slope to the numbers of the tree, before rounding.
float tree_number(float slope, float resolution, uint format) {
  float y = slope * resolution;
  float curve = abs(y) < 1e18 ? y / (1.0 + abs(y)) : sign(y);
  return format == kUnorm16 ? (0.5 + 0.5 * curve) * 65535.0 : curve;
}

// Returns the number of a ray. It is greater than that of a node without a minimum slope. Rays at the epipole are so
// steep that their number would be 0 as well, and count as lit.
float ray_number(float slope, float resolution, uint format) {
  const float kMinNumber = 0.01;
  float number = tree_number(slope, resolution, format);
  return format == kUnorm16 ? max(number, kMinNumber) : number;
}

// Returns the index of a node within its block; `cell` is any of its cells.
uint node_index(uint cell, uint level) {
  return kTreeNodes - (kTreeNodes >> (level - kTreeLeafLevel)) + (cell >> level);
}

#endif
