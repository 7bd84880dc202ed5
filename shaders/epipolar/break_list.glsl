// The list of pixels to be marched. If there are more than its capacity, none of them is marched, because the order in
// the list varies from run to run. Include after declaring breaks (WorkList), break_list (uint[]) and epipolar.
#ifndef TYNDALL_BREAK_LIST_GLSL
#define TYNDALL_BREAK_LIST_GLSL

#include "epipolar/work_list.glsl"

void list_break(ivec2 pixel) {
  uint slot = atomicAdd(breaks.count, 1u);
  if (slot >= epipolar.break_capacity) return;
  break_list[slot] = uint(pixel.y) << 16u | uint(pixel.x);
  uint groups = slot / kMarchGroup + 1u;
  atomicMax(breaks.groups_x, groups_along_x(groups));
  atomicMax(breaks.groups_y, groups_along_y(groups));
}

#endif
