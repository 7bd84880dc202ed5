// Scene files: TOML with one table for each group ([camera], [sun], ...) and the names of the parameters as keys. A
// file may be partial; parameters that it leaves out are not changed. Values are TOML numbers, arrays of numbers,
// booleans and strings. A camera path is an array of tables [[path]] and a table [playback] (docs/scenes.md); it
// replaces the previous path as a whole. `include` names files that are read first, relative to the folder of the file
// that includes them.
#pragma once

#include <string>
#include <string_view>

#include "config/settings.hpp"

namespace tyndall::config {

// Reads a scene file into `settings`, which do not change when it fails. A parameter that names a file is resolved
// relative to the scene file first, and then relative to the working directory. Errors: io when the file cannot be
// read, otherwise invalid_argument with the line.
[[nodiscard]] Result<void> load(Settings& settings, const std::string& path);

// Reads a scene file from text, which cannot include files. Errors call it `name`.
[[nodiscard]] Result<void> load_text(Settings& settings, std::string_view toml, std::string_view name);

// Returns a complete scene file, with the unit, range and meaning of each parameter as a comment. Loading it gives the
// same settings, bit for bit.
[[nodiscard]] std::string to_toml(const Settings& settings);

// Writes to_toml() to a file, completely or not at all.
[[nodiscard]] Result<void> save(const Settings& settings, const std::string& path);

}  // namespace tyndall::config
