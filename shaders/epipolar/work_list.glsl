// Lists for indirect dispatches: the number of workgroups for a list, and the item of an invocation.
#ifndef TYNDALL_WORK_LIST_GLSL
#define TYNDALL_WORK_LIST_GLSL

#include "shared/epipolar.h"

uint groups_along_x(uint groups) { return min(groups, kMaxGroups); }
uint groups_along_y(uint groups) { return (groups + kMaxGroups - 1u) / kMaxGroups; }

uint list_group() { return gl_WorkGroupID.y * kMaxGroups + gl_WorkGroupID.x; }
uint list_item(uint group_size) { return list_group() * group_size + gl_LocalInvocationID.x; }

#endif
