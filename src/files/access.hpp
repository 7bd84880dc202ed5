// Limits which files another file may name. Scenes and models come from other people, so what they name has to lie in
// their own folder, or below it, unless the user allows more.
#pragma once

#include <string>

namespace tyndall::files {

// Allows names of files anywhere, for the whole process: the option --allow-outside. Call it before files are read.
void allow_outside();
[[nodiscard]] bool outside_allowed();

// Returns whether the file or folder `path` lies in `folder` or below it, once symbolic links and ".." are resolved.
// The last parts of `path` need not exist.
[[nodiscard]] bool is_within(const std::string& path, const std::string& folder);

}  // namespace tyndall::files
