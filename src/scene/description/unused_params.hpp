// Parameters that were set but do nothing because of what others say.
#pragma once

#include <string>
#include <vector>

#include "scene/description/scene_params.hpp"

namespace tyndall::scene {

// One line for each reason, as "A and B have no effect with C = D". Only values that differ from their defaults count.
// What obviously belongs to something that is switched off (epipolar.* with brute force, ...) is not listed.
[[nodiscard]] std::vector<std::string> unused_params(const Params& params, const SceneParams& scene);

}  // namespace tyndall::scene
