// Scene files: TOML with one table per group ([camera], [sun], ...) and exactly the parameter names as
// keys. A file may be partial; what it leaves out keeps its value. Numbers, arrays of numbers,
// booleans and strings stand as TOML has them. A flight of the camera is a list [[path]] and a table [playback]
// (docs/scenes.md); it replaces the one before as a whole.
#pragma once

#include <string>
#include <string_view>

#include "config/settings.hpp"

namespace tyndall::config {

// Reads a scene file over `settings`, which stay as they are when it fails. A parameter that names a
// file is looked for next to the scene file first, and then from the working directory.
// Errors: io when the file cannot be read, invalid_argument ("WHAT, FILE:LINE, WHAT IS ALLOWED") else.
[[nodiscard]] Result<void> load(Settings& settings, const std::string& path);

// The same from text; `name` stands for the file in errors.
[[nodiscard]] Result<void> load_text(Settings& settings, std::string_view toml, std::string_view name);

// A complete scene file with the unit, range and meaning of each parameter as a comment. It loads back
// to the same settings, bit for bit.
[[nodiscard]] std::string to_toml(const Settings& settings);

// Writes to_toml() to a file, whole or not at all.
[[nodiscard]] Result<void> save(const Settings& settings, const std::string& path);

}  // namespace tyndall::config
