// Computes the start and end of each slice in the picture and the distribution of its samples (Yusov 2013, section
// 1.2). As the first pass of a frame, it also empties the lists that later passes fill.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "epipolar/slices.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 13) writeonly buffer slices_block { EpipolarSlice slices[]; };
layout(std430, binding = 14) writeonly buffer march_list_block { WorkList march; };
layout(std430, binding = 15) writeonly buffer tree_blocks_block { WorkList trees; };
layout(std430, binding = 16) writeonly buffer discontinuity_blocks_block { WorkList discontinuities; };
layout(std430, binding = 17) writeonly buffer correction_list_block { WorkList corrections; };

layout(push_constant) uniform Push {
  uint march_groups_z;  // workgroups along z of the dispatches over march_list
};

void empty_lists() {
  march = WorkList(0u, 1u, march_groups_z, 0u);
  trees = WorkList(0u, 1u, 1u, 0u);
  discontinuities = WorkList(0u, 1u, 1u, 0u);
  corrections = WorkList(0u, 1u, 1u, 0u);
}

// The part in the picture of a line from the epipole that leaves the picture at a distance along the perimeter.
struct Chord {
  vec2 exit;
  vec2 direction;
  float length_px;
};

Chord chord_at(float along) {
  Chord chord;
  chord.exit = border_position(along);
  chord.direction = away_from_epipole(chord.exit);
  bool across;
  chord.length_px = epipolar.sun_in_picture != 0u ? distance(chord.exit, epipole())
                                                  : distance_to_border(chord.exit, -chord.direction, across);
  return chord;
}

void main() {
  uint id = gl_GlobalInvocationID.x;
  if (id == 0u) empty_lists();
  if (id >= epipolar.slices) return;
  float steps = float(epipolar.closed != 0u ? epipolar.slices : epipolar.slices - 1u);
  float spacing = epipolar.perimeter / steps;
  Chord chord = chord_at(spacing * float(id));
  float visible = chord.length_px;
  // Pixels between two slices need samples on both. At a corner of the picture, one may be much shorter than the other.
  if (epipolar.sun_in_picture == 0u) {
    visible = max(visible, chord_at(max(spacing * (float(id) - 1.0), 0.0)).length_px);
    visible = max(visible, chord_at(min(spacing * (float(id) + 1.0), epipolar.perimeter)).length_px);
  }
  vec2 entry = chord.exit - chord.direction * visible;

  // Short slices are extended beyond the border, so that samples are at least a pixel apart (of the computed
  // resolution).
  float intervals = float(epipolar.samples - 1u);
  float stretched =
      epipolar.optimize_locations != 0u ? max(visible, intervals * float(epipolar.downscale)) : max(visible, 1e-3);
  EpipolarSlice slice;
  slice.line = vec4(entry, chord.direction * (intervals / stretched));
  slice.stride = chord.direction * (stretched / intervals);
  slice.last = uint(clamp(ceil(visible / stretched * intervals - 1e-3), 1.0, intervals));
  slice.first_marched = 0u;
  slices[id] = slice;
}
