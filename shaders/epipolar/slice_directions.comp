// The line of each slice in each marched cascade's map, and which parts of its tree are to be built (Yusov 2013,
// section 1.4). All rays of a slice lie in one
// plane with the direction to the sun, which the map shows as a line through the camera.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/medium.h"
#include "shared/frame_constants.h"
#include "shared/epipolar.h"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer frame_block { FrameConstants frame; };
layout(std430, binding = 1) readonly buffer epipolar_block { EpipolarConstants epipolar; };
layout(std430, binding = 2) readonly buffer slice_block { EpipolarSlice slices[]; };
layout(std430, binding = 3) writeonly buffer row_block { ShadowRow rows[]; };
layout(std430, binding = 4) buffer tree_list_block { WorkList trees; uint tree_list[]; };

#include "epipolar/slices.glsl"
#include "epipolar/work_list.glsl"
#include "frame/view_ray.glsl"

// Cells per metre of view depth along the ray through a place, and their direction.
vec2 texels_per_depth(mat4 shadow_from_world, vec2 position) {
  vec3 d = frame.ray_origin + position.x * frame.ray_x + position.y * frame.ray_y;
  float depth = max(dot(d, frame.camera_forward), 1e-12 * length(d));
  return (shadow_from_world * vec4(d, 0.0)).xy * (float(frame.shadow_resolution) / depth);
}

void main() {
  uint id = gl_GlobalInvocationID.x;
  uint cascade = epipolar.first_cascade + gl_GlobalInvocationID.y;
  if (id >= epipolar.slices || cascade >= epipolar.cascades) return;
  EpipolarSlice slice = slices[id];
  mat4 shadow_from_world = frame.cascades[cascade].shadow_from_world;
  vec3 camera = shadow_uvz(shadow_from_world, frame.camera_position);
  vec2 near = texels_per_depth(shadow_from_world, sample_position(slice, 0u));
  vec2 far = texels_per_depth(shadow_from_world, sample_position(slice, slice.last));
  float resolution = float(frame.shadow_resolution);
  float scale = max(abs(far.x), abs(far.y));
  vec2 step_uv = scale > 1e-12 ? far / (scale * resolution) : vec2(1.0 / resolution, 0.0);

  // Cells inside the map.
  vec2 slope = vec2(abs(step_uv.x) > 1e-12 ? step_uv.x : 1e-12, abs(step_uv.y) > 1e-12 ? step_uv.y : 1e-12);
  vec2 a = -camera.xy / slope;
  vec2 b = (1.0 - camera.xy) / slope;
  float inside = max(max(min(a.x, b.x), min(a.y, b.y)), 0.0);
  float outside = min(max(a.x, b.x), max(a.y, b.y));
  // Cells that rays of this slice cross in this cascade: along a slice, cells per depth grow steadily.
  float begins = cascade > epipolar.first_cascade ? frame.cascades[cascade - 1u].far_m : 0.0;
  float first = max(inside, begins * max(abs(near.x), abs(near.y)) - 1.0);
  float last = min(outside, frame.cascades[cascade].far_m * scale + 1.0);

  ShadowRow row;
  row.u = camera.x;
  row.v = camera.y;
  row.du = step_uv.x;
  row.dv = step_uv.y;
  row.depth = camera.z;
  row.first = int(clamp(floor(first), 0.0, 1e9));
  row.extent = int(clamp(ceil(last) - floor(first), 0.0, 1e6));
  row.count = min(row.extent, int(epipolar.tree_cells));
  uint row_id = gl_GlobalInvocationID.y * epipolar.slices + id;
  rows[row_id] = row;
  // The blocks of the tree that have cells; each is a group.
  uint blocks = (uint(row.count) + kTreeBlock - 1u) / kTreeBlock;
  uint at = atomicAdd(trees.count, blocks);
  atomicMax(trees.groups_x, groups_along_x(at + blocks));
  atomicMax(trees.groups_y, groups_along_y(at + blocks));
  for (uint i = 0u; i < blocks; ++i) tree_list[at + i] = row_id << 8u | i;
}
