// Filling of holes in rasters. Holes are NaN.
#pragma once

#include <vector>

namespace tyndall::scene {

// Replaces every NaN by a smooth continuation of what surrounds it: means over ever larger cells, taken
// linearly between their centres ("pull-push", Gortler et al., "The lumigraph", 1996). Row-major; at least
// one value must be finite.
void fill_holes(std::vector<float>& values, int width, int height);

}  // namespace tyndall::scene
