// The optional parts of the program, which depend on the libraries that it was built with.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tyndall::cli {

struct Feature {
  std::string_view name;
  bool built_in;
};

[[nodiscard]] std::vector<Feature> features();

// Returns what `tyndall --version` prints: the version in the first line, then the features that are built in and those
// that are not.
[[nodiscard]] std::string version_text();

}  // namespace tyndall::cli
