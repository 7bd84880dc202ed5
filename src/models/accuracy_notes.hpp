// Notes on atmospheres for which results are less accurate than docs/accuracy.md states.
#pragma once

#include <string>
#include <vector>

#include "tyndall/params.hpp"

namespace tyndall::models {

// Returns a note if the atmosphere scatters so much that the orders in the tables are too few (only if results come
// `from_tables`), and one if it is too high for its planet: optical depths along rays are computed in closed forms for
// scale heights that are small compared with the radius.
[[nodiscard]] std::vector<std::string> accuracy_notes(const Params& params, bool from_tables);

}  // namespace tyndall::models
