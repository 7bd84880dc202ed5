// Finds parameters that were set but have no effect because of other parameters.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/description/scene_params.hpp"

namespace tyndall::scene {

// Returns "A, B have no effect" for those of `keys` that `names` contains, or an empty string. Names are those of
// parameters, or of groups, which end in a full stop.
[[nodiscard]] std::string without_effect(std::span<const std::string> keys, std::span<const std::string_view> names);

// Returns one line for each reason, as "A, B have no effect with C = D". Only values that differ from their defaults
// count. Parameters that obviously belong to something that is switched off (epipolar.* with brute force) are not
// listed.
[[nodiscard]] std::vector<std::string> unused_params(const Params& params, const SceneParams& scene);

}  // namespace tyndall::scene
