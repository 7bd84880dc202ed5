// The models of `probe`: one row each, all with the same interface.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "models/homogeneous.hpp"
#include "models/single_scattering.hpp"
#include "rays/ray_query.hpp"
#include "scene/description/model_registry.hpp"
#include "scene/description/scene_params.hpp"
#include "tables/make_ready.hpp"
#include "tyndall/params.hpp"
#include "tyndall/result.hpp"

namespace tyndall::cli {

struct ProbeAnswer {
  // L / E0 [1/sr]; for the sky E / E0. With scattering.color = spectral: linear Rec. 709 in the unit of xyz over 683.
  std::array<double, 3> radiance = {};
  // Transmittance to the end of the ray. For the sky, the transmittance of sunlight, or 0 if the planet hides the sun.
  // With scattering.color = spectral: that of each channel of the colour of sunlight.
  std::array<double, 3> transmittance = {};
  std::array<double, 3> standard_error = {};  // standard error of the radiance; 0 for models without noise
  bool single_precision = false;              // the numbers are floats, and are printed as such
  std::array<double, 3> xyz = {};             // with scattering.color = spectral: CIE XYZ [cd/m^2, sky: lux]
};

struct ProbeSettings {
  Params params;
  scene::SceneParams scene;  // for models with their own parameters
  std::uint32_t orders = 8;
  std::uint32_t samples = 100000;
  std::uint32_t seed = 1;
  // Only the queries with the indices first, first + stride and so on are evaluated.
  std::uint32_t first = 0;
  std::uint32_t stride = 1;
  std::string device;
  tables::CacheDesc table_cache = {};
  std::function<void(const std::string& text)> note;  // receives remarks for the user; may be empty
  std::function<void(double done)> progress;          // receives the completed fraction, 0 to 1
};

// Returns the answer of a model for its channels as `probe` prints it.
[[nodiscard]] ProbeAnswer probe_answer(const Params& params, const models::Answer& answer, bool single_precision);

// Returns the optical lengths that the scene's parameters set for the homogeneous model.
[[nodiscard]] models::HomogeneousLengths homogeneous_lengths(const scene::SceneParams& scene);

// A model that is computed on the CPU in double precision: all except precomputed, single and reference.
struct CpuModel {
  std::function<models::Answer(const RayQuery&)> answer;  // may be called by several threads at once
  std::vector<std::string> notes;                         // remarks for the user, one line each
};
// Returns such a model. For precomputed, single and reference, `answer` is empty.
[[nodiscard]] CpuModel cpu_model(scene::ModelId model, const Params& params, const scene::SceneParams& scene);

// Returns an error if a model has three channels only, and spectral colours are requested.
[[nodiscard]] Result<void> check_color(scene::ModelId model, ColorMode color);
// Returns an error if a model does not support the phase function.
[[nodiscard]] Result<void> check_phase(scene::ModelId model, const AtmosphereParams& atmosphere);

// Evaluates the chosen queries with one of the models. The result of a query does not depend on which others are
// chosen.
[[nodiscard]] Result<std::vector<ProbeAnswer>> evaluate_model(scene::ModelId model, const ProbeSettings& settings,
                                                              std::span<const RayQuery> queries);

}  // namespace tyndall::cli
