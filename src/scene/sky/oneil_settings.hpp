// Derives the settings of O'Neil's model from the parameters of the scene.
#pragma once

#include "models/oneil.hpp"
#include "scene/description/scene_params.hpp"

namespace tyndall::scene {

// Returns the settings. With `table`, the model uses O'Neil's table of 2004 instead of a scale function.
[[nodiscard]] inline models::OneilSettings oneil_settings(const OneilParams& params, bool table) {
  models::OneilSettings out;
  out.integral_method =
      table ? models::OneilIntegralMethod::table : static_cast<models::OneilIntegralMethod>(params.scale_function);
  out.samples = params.samples;
  out.table_size = params.table_size;
  out.space_by_density = params.spacing == OneilSpacing::column;
  out.rayleigh_phase = params.rayleigh_phase.value != 0;
  return out;
}

}  // namespace tyndall::scene
