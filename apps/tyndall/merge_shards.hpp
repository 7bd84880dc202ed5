// Combines the results of shards, which their manifests describe: the work of `tyndall merge`.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tyndall/result.hpp"
#include "validate_models.hpp"

namespace tyndall::cli {

// Reads the manifests at `paths` and the results beside them, and writes the combination to `output`. `models` returns
// the models of `validate`; it is called only for reports, and no model is evaluated. Errors name the manifest.
[[nodiscard]] Result<void> merge_shards(const std::string& output, const std::vector<std::string>& paths,
                                        const std::function<ValidateModels()>& models);

}  // namespace tyndall::cli
