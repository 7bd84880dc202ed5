// The exposure of a scene that is given as for a camera: by its exposure value, or by aperture, shutter and ISO speed.
#pragma once

#include <optional>

#include "scene/description/scene_params.hpp"
#include "tyndall/result.hpp"

namespace tyndall::scene {

// Returns the exposure value at ISO 100 that tonemap.exposure_ev100, or tonemap.aperture and tonemap.shutter_s set;
// nothing if they are not set. Precondition: check_camera_exposure() accepts the parameters.
[[nodiscard]] std::optional<double> camera_ev100(const TonemapParams& tonemap);

// Returns whether the exposure follows from the picture.
[[nodiscard]] bool is_auto_exposed(const TonemapParams& tonemap);

// Fails (invalid_argument) if the exposure is given twice, or only half of the camera's settings.
[[nodiscard]] Result<void> check_camera_exposure(const TonemapParams& tonemap);

}  // namespace tyndall::scene
