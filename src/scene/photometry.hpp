// The unit of a scene's pictures, and its exposure.
#pragma once

#include "post/tonemap.hpp"
#include "scene/description/scene_params.hpp"
#include "tyndall/params.hpp"

namespace tyndall::scene {

// Returns the luminance of the colour (1, 1, 1) in pictures of the scene [cd/m^2]; 0 if the sun has no light. See
// tyndall/photometry.hpp.
[[nodiscard]] double white_luminance(const Params& params, const SceneParams& scene);

// Returns the settings of tone mapping, in which an exposure that is given as for a camera is a factor.
[[nodiscard]] post::TonemapSettings tonemap_settings(const Params& params, const SceneParams& scene);

}  // namespace tyndall::scene
