// Finds parameters that were set but have no effect because of other parameters.
#pragma once

#include <string>
#include <vector>

#include "scene/description/scene_params.hpp"

namespace tyndall::scene {

// Returns one line for each reason, as "A, B have no effect with C = D". Only values that differ from their defaults
// count. Parameters that obviously belong to something that is switched off (epipolar.* with brute force) are not
// listed.
[[nodiscard]] std::vector<std::string> unused_params(const Params& params, const SceneParams& scene);

}  // namespace tyndall::scene
