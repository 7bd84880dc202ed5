// Lists for indirect dispatches: the number of workgroups for a list, the item of an invocation, and places for new
// items.
#ifndef TYNDALL_WORK_LIST_GLSL
#define TYNDALL_WORK_LIST_GLSL

#ifdef TARGET_GPU
#extension GL_KHR_shader_subgroup_ballot : require
#endif

#include "shared/epipolar.h"

uint groups_along_x(uint groups) { return min(groups, kMaxGroups); }
uint groups_along_y(uint groups) { return (groups + kMaxGroups - 1u) / kMaxGroups; }

// Reserves places in `list` for `count` items of every invocation that executes it. Sets `at` to the first place of the
// invocation and `end` to the number of items of the list with all reservations. Sets `leads` in invocations that must
// update the number of workgroups. On GPUs, a subgroup executes one atomic operation on the list. On CPU devices the
// subgroup is eight invocations, and gathering them takes longer than it saves.
#ifdef TARGET_GPU
#define RESERVE(list, count_each, at, end, leads)                                                   \
  {                                                                                                 \
    uvec4 reserving = subgroupBallot(true);                                                         \
    leads = subgroupElect();                                                                        \
    uint first_place = 0u;                                                                          \
    if (leads) first_place = atomicAdd(list.count, (count_each)*subgroupBallotBitCount(reserving)); \
    first_place = subgroupBroadcastFirst(first_place);                                              \
    at = first_place + (count_each)*subgroupBallotExclusiveBitCount(reserving);                     \
    end = first_place + (count_each)*subgroupBallotBitCount(reserving);                             \
  }
#else
#define RESERVE(list, count_each, at, end, leads) \
  {                                               \
    leads = true;                                 \
    at = atomicAdd(list.count, count_each);       \
    end = at + (count_each);                      \
  }
#endif

uint list_group() { return gl_WorkGroupID.y * kMaxGroups + gl_WorkGroupID.x; }
uint list_item(uint group_size) { return list_group() * group_size + gl_LocalInvocationID.x; }

#endif
