// Evaluates the models on the GPU with shaders/probe, one invocation per ray. Rays are processed in batches, so that
// any number of them fits on the device.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "effect/phase_rows.hpp"
#include "gpu/host.hpp"
#include "gpu/pipeline.hpp"
#include "models/oneil.hpp"
#include "models/single_scattering.hpp"

namespace tyndall::models {

// Evaluates single scattering over black ground with shaders/probe/single.comp in single precision. Returns one answer
// per ray, in order. `phase`: the rows of the medium's phase function, empty if it has a formula. `progress` receives
// the number of completed rays.
Result<std::vector<Answer>> single_scattering_on_gpu(gpu::Host& host, const shared::SpectralMedium& medium,
                                                     const PhaseRows& phase, ColorMode color, std::span<const Ray> rays,
                                                     const std::function<void(std::size_t)>& progress = {});

// Evaluates single scattering in the same way, with a pipeline that is made once for many calls. Use it from one thread
// at a time.
class SingleScatteringOnGpu {
 public:
  // `host` must outlive the object.
  static Result<SingleScatteringOnGpu> create(gpu::Host& host, ColorMode color);
  [[nodiscard]] Result<std::vector<Answer>> answer(const shared::SpectralMedium& medium, const PhaseRows& phase,
                                                   std::span<const Ray> rays,
                                                   const std::function<void(std::size_t)>& progress = {}) const;

 private:
  gpu::Host* host_ = nullptr;
  gpu::Pipeline pipeline_;
};

// Evaluates single scattering in three channels, with a phase function that has a formula.
Result<std::vector<Answer>> single_scattering_on_gpu(gpu::Host& host, const shared::Medium& medium,
                                                     std::span<const Ray> rays,
                                                     const std::function<void(std::size_t)>& progress = {});

// Evaluates O'Neil's model with shaders/probe/oneil.comp.
Result<std::vector<Answer>> oneil_on_gpu(gpu::Host& host, const OneilModel& model, std::span<const Ray> rays);

}  // namespace tyndall::models
