// Computes the start and end of each slice in the picture and the distribution of its samples (Yusov 2013, section
// 1.2).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "epipolar/slices.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 13) writeonly buffer slices_block { EpipolarSlice slices[]; };

void main() {
  uint id = gl_GlobalInvocationID.x;
  if (id >= epipolar.slices) return;
  float steps = float(epipolar.closed != 0u ? epipolar.slices : epipolar.slices - 1u);
  vec2 exit = border_position(epipolar.perimeter * float(id) / steps);
  vec2 direction = away_from_epipole(exit);
  bool across;
  float visible = distance_to_border(exit, -direction, across);
  if (epipolar.sun_in_picture != 0u) visible = distance(exit, epipole());
  vec2 entry = exit - direction * visible;

  // Short slices are extended beyond the border, so that samples are at least a pixel apart (of the computed
  // resolution).
  float intervals = float(epipolar.samples - 1u);
  float stretched =
      epipolar.optimize_locations != 0u ? max(visible, intervals * float(epipolar.downscale)) : max(visible, 1e-3);
  EpipolarSlice slice;
  slice.line = vec4(entry, direction * (intervals / stretched));
  slice.stride = direction * (stretched / intervals);
  slice.last = uint(clamp(ceil(visible / stretched * intervals - 1e-3), 1.0, intervals));
  slice.first_marched = 0u;
  slices[id] = slice;
}
