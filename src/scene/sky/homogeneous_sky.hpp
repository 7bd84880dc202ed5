// The model of Hoffman and Preetham (2002) as a SkyModel: scattering.model = homogeneous.
#pragma once

#include "scene/sky/sky_model.hpp"

namespace tyndall::scene {

Result<std::unique_ptr<SkyModel>> create_homogeneous_sky(gpu::Host& host, ModelEvaluation evaluation,
                                                         VkFormat color_format, VkFormat depth_format);

}  // namespace tyndall::scene
