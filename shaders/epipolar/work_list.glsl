// Lists that are worked through by an indirect dispatch: how many groups of it a list takes, and which item of it
// an invocation has.
#ifndef TYNDALL_WORK_LIST_GLSL
#define TYNDALL_WORK_LIST_GLSL

#include "shared/epipolar.h"

uint groups_along_x(uint groups) { return min(groups, kMostGroups); }
uint groups_along_y(uint groups) { return (groups + kMostGroups - 1u) / kMostGroups; }

uint list_group() { return gl_WorkGroupID.y * kMostGroups + gl_WorkGroupID.x; }
uint list_item(uint group_size) { return list_group() * group_size + gl_LocalInvocationID.x; }

#endif
