// The counters of a frame, in the order of tyndall::Counters (include/tyndall/effect.hpp).
#ifndef TYNDALL_SHARED_COUNTERS
#define TYNDALL_SHARED_COUNTERS

const uint kSamplesMarched = 0u;  // rays: epipolar samples, or pixels with brute force
const uint kMarchSteps = 1u;      // stretches of a ray that were classified as lit or shadowed
const uint kNodesVisited = 2u;    // nodes of the min/max trees
const uint kShadowFetches = 3u;   // comparisons with the shadow maps
const uint kPixelsCorrected = 4u;
const uint kCounters = 5u;

#endif
