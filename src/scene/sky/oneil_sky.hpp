// O'Neil's model as a SkyModel: scattering.model = oneil and oneil-table.
#pragma once

#include "scene/sky/sky_model.hpp"

namespace tyndall::scene {

Result<std::unique_ptr<SkyModel>> create_oneil_sky(gpu::Host& host, ModelEvaluation evaluation, bool table,
                                                   VkFormat color_format, VkFormat depth_format);

}  // namespace tyndall::scene
