#include "scene/description/model_registry.hpp"

#include <algorithm>
#include <cstddef>

namespace tyndall::scene {
namespace {

using Drawn = ScatteringModel;

constexpr ModelInfo kModels[] = {
    {ModelId::precomputed, "precomputed", "all orders, from the renderer's tables", 0, false,
     DrawnBy{Drawn::atmosphere, MediumKind::atmosphere}, "Atmosphere, all orders, shafts (Yusov 2013)"},
    {ModelId::single, "single", "light scattered once, integrated for every ray", 1, false, {}, nullptr},
    {ModelId::homogeneous, "homogeneous",
     "Hoffman and Preetham: closed forms for one density at every altitude, no ozone, no other sunset "
     "than the horizontal",
     1, false, DrawnBy{Drawn::homogeneous}, "Air and haze (Hoffman, Preetham 2002)"},
    {ModelId::homogeneous_medium, "homogeneous-medium",
     "Yusov 2012: scattering.medium = homogeneous, wholly lit: one density out to its extent, "
     "sunlight that nothing takes from, no sunset",
     1, false, DrawnBy{Drawn::atmosphere, MediumKind::homogeneous}, "Homogeneous medium, shafts (Yusov 2012)"},
    {ModelId::oneil, "oneil", "O'Neil: light scattered once, few points and the scale function, no ozone", 1, false,
     DrawnBy{Drawn::oneil}, "Scale function (O'Neil 2005)"},
    {ModelId::oneil_table, "oneil-table", "the same as oneil with the table of 2004", 1, false,
     DrawnBy{Drawn::oneil_table}, "Table (O'Neil 2004)"},
    {ModelId::reference, "reference", "the path tracer", 0, true, {}, nullptr},
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

const ModelInfo& drawn_model(const Params& params, const SceneParams& scene) {
  const Drawn model = scene.scattering.model;
  const auto draws = [&](const ModelInfo& info) {
    return info.drawn_by && info.drawn_by->model == model &&
           (model != Drawn::atmosphere || info.drawn_by->medium == params.scattering.medium);
  };
  return *std::find_if(std::begin(kModels), std::end(kModels), draws);
}

}  // namespace tyndall::scene
