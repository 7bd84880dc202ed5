// The list of pixels to be marched. If there are more than its capacity, none of them is marched, because the order in
// the list varies from run to run.
#ifndef TYNDALL_CORRECTION_LIST_GLSL
#define TYNDALL_CORRECTION_LIST_GLSL

#include "epipolar/constants.glsl"
#include "epipolar/work_list.glsl"

layout(std430, binding = 17) buffer correction_list_block {
  WorkList corrections;
  uint correction_list[];
};

void list_correction(ivec2 pixel) {
  uint slot, end;
  bool leads;
  RESERVE(corrections, 1u, slot, end, leads)
  if (slot < epipolar.correction_capacity) correction_list[slot] = uint(pixel.y) << 16u | uint(pixel.x);
  if (!leads || slot >= epipolar.correction_capacity) return;
  uint groups = (min(end, epipolar.correction_capacity) + kMarchGroup - 1u) / kMarchGroup;
  atomicMax(corrections.groups_x, groups_along_x(groups));
  atomicMax(corrections.groups_y, groups_along_y(groups));
}

#endif
