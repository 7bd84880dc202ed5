// Formats the list of parameters, as `tyndall params` prints it.
#pragma once

#include <string>

#include "config/settings.hpp"

namespace tyndall::config {

// Returns Markdown with one table for each group: name, type, default, range, unit, what a change makes stale, meaning.
[[nodiscard]] std::string to_markdown();

// Returns JSON: {"version", "parameters": [{"name", "group", "type", "default", "value", "min", "max", "unit",
// "choices", "affects", "doc"}]}: `value` is that of `settings`; min, max only for numbers, choices only
// for enumerations. Numbers are numbers, vectors are arrays.
[[nodiscard]] std::string to_json(const Settings& settings);

}  // namespace tyndall::config
