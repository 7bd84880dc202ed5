// The models that `validate` compares with the reference: the rows of its report.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/description/scene_params.hpp"
#include "tables/make_ready.hpp"
#include "validate/color.hpp"
#include "validate/study.hpp"

namespace tyndall::cli {

struct ValidateModels {
  std::vector<validate::Model> rays;     // models for all rays of the study
  std::vector<validate::Model> horizon;  // parameterisations of the tables, for the horizon test
  std::vector<validate::ColorModel> colors;
  std::function<std::vector<std::string>()> notes;  // returns remarks on the cache
};

// Returns the models. They create devices and tables when they are first evaluated.
[[nodiscard]] ValidateModels validate_models(const std::string& device, const scene::SceneParams& scene,
                                             const tables::CacheDesc& cache);

}  // namespace tyndall::cli
