// Fills holes in rasters. Holes are NaN.
#pragma once

#include <vector>

namespace tyndall::scene {

// Replaces every NaN by a smooth continuation of its surroundings: means over increasingly large cells, interpolated
// linearly between their centres ("pull-push", Gortler et al., "The lumigraph", 1996). The values are row-major. At
// least one must be finite.
void fill_holes(std::vector<float>& values, int width, int height);

}  // namespace tyndall::scene
