#include "scene/description/model_registry.hpp"

#include <algorithm>
#include <cstddef>

namespace tyndall::scene {
namespace {

using Drawn = ScatteringModel;

constexpr ModelInfo kModels[] = {
    {ModelId::precomputed, "precomputed", "all orders of scattering, from the renderer's tables", 0, false, true,
     DrawnBy{Drawn::atmosphere, MediumKind::atmosphere}, "Atmosphere, all orders, light shafts (Yusov 2013)"},
    {ModelId::single, "single", "single scattering, integrated along every ray", 1, false, true, {}, nullptr},
    {ModelId::homogeneous, "homogeneous",
     "Hoffman and Preetham 2002: single scattering in closed form; the same density at every altitude, no ozone, and "
     "the sun sets at the horizontal",
     1, false, false, DrawnBy{Drawn::homogeneous}, "Air and haze (Hoffman and Preetham 2002)"},
    {ModelId::homogeneous_medium, "homogeneous-medium",
     "Yusov 2012: scattering.medium = homogeneous without shadows; constant density, sunlight that is not attenuated, "
     "and no sunset",
     1, false, true, DrawnBy{Drawn::atmosphere, MediumKind::homogeneous},
     "Homogeneous medium, light shafts (Yusov 2012)"},
    {ModelId::oneil, "oneil",
     "O'Neil 2005: single scattering from a few sample points and the scale function, without ozone", 1, false, false,
     DrawnBy{Drawn::oneil}, "Scale function (O'Neil 2005)"},
    {ModelId::oneil_table, "oneil-table", "O'Neil 2004: oneil with a table instead of the scale function", 1, false,
     false, DrawnBy{Drawn::oneil_table}, "Table (O'Neil 2004)"},
    {ModelId::reference, "reference", "the path tracer", 0, true, true, {}, nullptr},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < std::size(kModels); ++i) {
    if (static_cast<std::size_t>(kModels[i].id) != i) return false;
  }
  return true;
}
static_assert(in_order(), "model_info() indexes the list by ModelId");

}  // namespace

std::span<const ModelInfo> model_registry() { return kModels; }

const ModelInfo& model_info(ModelId id) { return kModels[static_cast<std::size_t>(id)]; }

const ModelInfo* find_model(std::string_view name) {
  const auto* const found =
      std::find_if(std::begin(kModels), std::end(kModels), [&](const ModelInfo& info) { return info.name == name; });
  return found == std::end(kModels) ? nullptr : found;
}

const ModelInfo& drawn_model(const Params& params, const SceneParams& scene) {
  const Drawn model = scene.scattering.model;
  const auto draws = [&](const ModelInfo& info) {
    return info.drawn_by && info.drawn_by->model == model &&
           (model != Drawn::atmosphere || info.drawn_by->medium == params.scattering.medium);
  };
  return *std::find_if(std::begin(kModels), std::end(kModels), draws);
}

}  // namespace tyndall::scene
