// A tree of the shadow casters along a row (Yusov 2013, section 1.5), over slopes in place of depths (after
// Chen, Baran, Durand and Jarosz, "Real-Time Volumetric Shadows using 1D Min-Max Mipmaps", 2011): seen from the
// camera, where every ray of the slice begins, a caster of depth d in cell x is met by the rays that change depth by
// more than (d - camera's) / x per cell. A ray has one such slope, so that a node tells all its rays apart: lit
// below its least slope, dark above its greatest, and in between undecided.
// The numbers kept are steps of the curve y / (1 + |y|), which maps all slopes to [-1; 1] in order.
#ifndef TYNDALL_SHADOW_TREE_GLSL
#define TYNDALL_SHADOW_TREE_GLSL

const uint kUnorm16 = 0u;  // MinMaxFormat
const uint kFloat32 = 1u;

// A slope in the numbers of the tree, before they are rounded.
float tree_number(float slope, float resolution, uint format) {
  float y = slope * resolution;
  float curve = abs(y) < 1e18 ? y / (1.0 + abs(y)) : sign(y);
  return format == kUnorm16 ? (0.5 + 0.5 * curve) * 65535.0 : curve;
}

// The number of a ray, which is above that of a node that knows no least slope. Rays at the epipole are so steep that
// theirs would be 0 as well, and count as lit.
float ray_number(float slope, float resolution, uint format) {
  const float kLeastNumber = 0.01;
  float number = tree_number(slope, resolution, format);
  return format == kUnorm16 ? max(number, kLeastNumber) : number;
}

// Of a node within its block: `cell` is any of its cells.
uint node_index(uint cell, uint level) {
  return kTreeNodes - (kTreeNodes >> (level - kTreeLeafLevel)) + (cell >> level);
}

#endif
