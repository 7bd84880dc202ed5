// Computes the slice line of each slice in the shadow map of each marched cascade, and the parts of its tree to be
// built (Yusov 2013, section 1.4). All rays of a slice lie in a plane that contains the direction to the sun. In the
// map the plane is a line through the camera. Few rays of a slice cross distant cascades, and rays near the sun cross
// few texels of the map. The tree therefore contains only cells that the ray of a marched sample reaches.
#version 460
#extension GL_GOOGLE_include_directive : require

#define COPY_CONSTANTS

#include "epipolar/slices.glsl"
#include "epipolar/work_list.glsl"
#include "frame/shadow_maps.glsl"
#include "frame/view_ray.glsl"

const uint kLines = 8u;  // slice lines of a workgroup

layout(local_size_x = kLines * kLineThreads) in;

layout(std430, binding = 13) readonly buffer slices_block { EpipolarSlice slices[]; };
layout(std430, binding = 15) writeonly buffer slice_lines_block { SliceLine slice_lines[]; };
layout(std430, binding = 16) buffer tree_blocks_block {
  WorkList trees;
  uint tree_list[];
};
layout(std430, binding = 17) readonly buffer march_list_block {
  WorkList march;
  uint march_list[];
};
layout(std430, binding = 14) readonly buffer samples_block { uvec4 samples[]; };

// Returns cells per metre of view depth along the ray through a position, and their direction.
vec2 texels_per_depth(mat4 shadow_from_world, vec2 position) {
  vec3 d = frame.ray_origin + position.x * frame.ray_x + position.y * frame.ray_y;
  float depth = max(dot(d, frame.camera_forward), 1e-12 * length(d));
  return (shadow_from_world * vec4(d, 0.0)).xy * (float(frame.shadow_resolution) / depth);
}

float begin_of(uint cascade) { return cascade > epipolar.first_cascade ? cascades[cascade - 1u].far_m : 0.0; }

shared float reaches[kLines * kLineThreads];

// Returns how far rays of marched samples of a slice reach in a cascade [cells from the camera], for every
// kLineThreads-th sample from `first` on.
float reach_of(EpipolarSlice slice, uint id, uint cascade, uint first) {
  float begin = begin_of(cascade);
  float far_m = cascades[cascade].far_m;
  mat4 shadow_from_world = cascades[cascade].shadow_from_world;
  float reach = 0.0;
  for (uint at = slice.first_marched + first; at < march.count && march_list[at] >> 16u == id; at += kLineThreads) {
    uint i = march_list[at] & 0xFFFFu;
    float depth_m = uintBitsToFloat(samples[id * epipolar.samples + i].x);
    vec2 cells = texels_per_depth(shadow_from_world, sample_position(slice, i));
    if (depth_m > begin) reach = max(reach, min(depth_m, far_m) * max(abs(cells.x), abs(cells.y)));
  }
  return reach;
}

SliceLine slice_line_of(EpipolarSlice slice, uint cascade, float reach_cells) {
  mat4 shadow_from_world = cascades[cascade].shadow_from_world;
  vec3 camera = shadow_uvz(shadow_from_world, frame.camera_position);
  vec2 near = texels_per_depth(shadow_from_world, sample_position(slice, 0u));
  vec2 far = texels_per_depth(shadow_from_world, sample_position(slice, slice.last));
  float resolution = float(frame.shadow_resolution);
  float scale = max(abs(far.x), abs(far.y));
  vec2 step_uv = scale > 1e-12 ? far / (scale * resolution) : vec2(1.0 / resolution, 0.0);

  // The cells inside the map.
  vec2 slope = vec2(abs(step_uv.x) > 1e-12 ? step_uv.x : 1e-12, abs(step_uv.y) > 1e-12 ? step_uv.y : 1e-12);
  vec2 a = -camera.xy / slope;
  vec2 b = (1.0 - camera.xy) / slope;
  float inside = max(max(min(a.x, b.x), min(a.y, b.y)), 0.0);
  float outside = min(max(a.x, b.x), max(a.y, b.y));
  // The cells that rays of this slice cross in this cascade. Cells per metre of depth grow monotonically along a slice.
  float first = max(inside, begin_of(cascade) * max(abs(near.x), abs(near.y)) - 1.0);
  float last = min(outside, cascades[cascade].far_m * scale + 1.0);

  SliceLine out_line;
  out_line.line = vec4(camera.xy, step_uv);
  out_line.depth = camera.z;
  out_line.cells.x = int(clamp(floor(first), 0.0, 1e9));
  out_line.cells.y = int(clamp(ceil(last) - floor(first), 0.0, 1e6));
  float reached = ceil(min(reach_cells + 1.0, 1e9)) - float(out_line.cells.x);
  out_line.cells.z = int(clamp(reached, 0.0, float(min(out_line.cells.y, int(epipolar.tree_cells)))));
  return out_line;
}

void main() {
  load_frame();
  load_epipolar();
  uint cascade = epipolar.first_cascade + gl_WorkGroupID.y;
  uint thread = gl_LocalInvocationID.x;
  // First, kLineThreads threads find the reach of each slice line. Then one thread computes the line.
  uint id = gl_WorkGroupID.x * kLines + thread / kLineThreads;
  bool reaches_tree = epipolar.tree_cells > 0u && id < epipolar.slices;
  reaches[thread] = reaches_tree ? reach_of(slices[id], id, cascade, thread % kLineThreads) : 0.0;
  barrier();
  id = gl_WorkGroupID.x * kLines + thread;
  if (thread >= kLines || id >= epipolar.slices) return;
  float reach = 0.0;
  for (uint i = 0u; i < kLineThreads; ++i) reach = max(reach, reaches[thread * kLineThreads + i]);
  SliceLine slice_line = slice_line_of(slices[id], cascade, reach);
  uint line_id = gl_WorkGroupID.y * epipolar.slices + id;
  slice_lines[line_id] = slice_line;
  // The blocks of the tree that contain cells.
  uint blocks = (uint(slice_line.cells.z) + kTreeBlock - 1u) / kTreeBlock;
  uint at = atomicAdd(trees.count, blocks);
  uint groups = (at + blocks + kTreeGroup - 1u) / kTreeGroup;
  atomicMax(trees.groups_x, groups_along_x(groups));
  atomicMax(trees.groups_y, groups_along_y(groups));
  for (uint i = 0u; i < blocks; ++i) tree_list[at + i] = line_id << 8u | i;
}
