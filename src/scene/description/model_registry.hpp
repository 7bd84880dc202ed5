// The list of all models of light scattering, used by `probe`, `validate`, `sky`, the menu of the viewer, and remarks
// on unused parameters. Code that computes or draws a model is selected by its id.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "scene/description/scene_params.hpp"

namespace tyndall::scene {

enum class ModelId : std::uint32_t {
  precomputed,
  single,
  homogeneous,
  homogeneous_medium,
  oneil,
  oneil_table,
  reference
};

// The parameters with which the scene is drawn by a model.
struct DrawnBy {
  ScatteringModel model = ScatteringModel::atmosphere;
  MediumKind medium = MediumKind::atmosphere;  // compared only if `model` is ScatteringModel::atmosphere
};

struct ModelInfo {
  ModelId id;
  std::string_view name;     // for --model
  std::string_view meaning;  // one line, for reports
  int orders;                // number of orders of scattering; 0: all
  bool random;               // its results have a standard error
  bool spectral;             // scattering.color = spectral is supported
  std::optional<DrawnBy> drawn_by;
  const char* title;  // in menus; nullptr if it cannot draw the scene
};

// Returns all models in the order of ModelId.
[[nodiscard]] std::span<const ModelInfo> model_registry();
[[nodiscard]] const ModelInfo& model_info(ModelId id);
// Returns the model with this name, or null.
[[nodiscard]] const ModelInfo* find_model(std::string_view name);
// Returns the model that these parameters draw with.
[[nodiscard]] const ModelInfo& drawn_model(const Params& params, const SceneParams& scene);

}  // namespace tyndall::scene
