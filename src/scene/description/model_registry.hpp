// The models of light scattering: the one list that `probe`, `validate`, `sky`, the viewer's menu and remarks about
// unused parameters read. How each of them is computed or drawn is found by its id.
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
  MediumKind medium = MediumKind::atmosphere;  // counts with ScatteringModel::atmosphere
};

struct ModelInfo {
  ModelId id;
  std::string_view name;     // of --model
  std::string_view meaning;  // one line, for reports
  int orders;                // of scattering that it computes; 0: all
  bool random;               // its answers have a standard error
  std::optional<DrawnBy> drawn_by;
  const char* title;  // in menus; nullptr where the scene is not drawn by it
};

// Returns all models in the order of ModelId.
[[nodiscard]] std::span<const ModelInfo> model_registry();
[[nodiscard]] const ModelInfo& model_info(ModelId id);
// Returns the model that these parameters draw with.
[[nodiscard]] const ModelInfo& drawn_model(const Params& params, const SceneParams& scene);

}  // namespace tyndall::scene
