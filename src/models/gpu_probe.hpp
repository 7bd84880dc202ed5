// The models as the GPU answers them: rays go up, shaders/probe answers each with one invocation. Rays are
// prepared and results taken back in batches, so that any number of them fits the device.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "gpu/host.hpp"
#include "models/oneil.hpp"
#include "models/single_scattering.hpp"

namespace tyndall::models {

// Light scattered once over black ground, by shaders/probe/single.comp in single precision: one answer per
// ray, in their order. `progress` is told how many are done.
Result<std::vector<Answer>> single_scattering_on_gpu(gpu::Host& host, const shared::Medium& medium,
                                                     std::span<const Ray> rays,
                                                     const std::function<void(std::size_t)>& progress = {});

// The same of O'Neil's model, by shaders/probe/oneil.comp.
Result<std::vector<Answer>> oneil_on_gpu(gpu::Host& host, const OneilModel& model, std::span<const Ray> rays);

}  // namespace tyndall::models
