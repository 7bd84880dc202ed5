// Where the viewer finds scenes and shaders, and where it leaves what it writes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tyndall::viewer {

struct SceneFile {
  std::string name;  // without the ending
  std::string path;
};

// Scene files in a folder that comes with the program ("scenes", "scenes/presets"), by name: beside the sources
// that it was built from, or where it is installed. $TYNDALL_DATA names another place.
[[nodiscard]] std::vector<SceneFile> shipped_scenes(std::string_view folder);
// The folder of that name ("shaders"), or an empty text.
[[nodiscard]] std::string shipped_folder(std::string_view folder);

// $XDG_STATE_HOME/tyndall/view.toml, or else in $HOME/.local/state, or else in the working directory.
[[nodiscard]] std::string default_state_file();
// Makes the folder of a file, where it is missing. False when that cannot be.
bool make_folder_of(const std::string& path);

// "tyndall-20260131-235959" in a folder (empty: the working directory), with "-2", "-3" ... when there is such a
// file with one of the endings.
[[nodiscard]] std::string screenshot_stem(const std::string& folder, const std::vector<std::string>& endings);

// Whether the first-run overlay has been put away before; the mark is left by the second.
[[nodiscard]] bool first_run(const std::string& state_file);
void leave_first_run_mark(const std::string& state_file);

}  // namespace tyndall::viewer
