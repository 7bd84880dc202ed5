// The files of the viewer: the scenes and shaders that come with it, and those that it writes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tyndall::viewer {

struct SceneFile {
  std::string name;  // without the extension
  std::string path;
};

// Returns the scene files in a folder that comes with the program ("scenes", "scenes/presets"), sorted by name. The
// folder is in the source tree that the program was built from, or where the program is installed; $TYNDALL_DATA
// overrides it.
[[nodiscard]] std::vector<SceneFile> shipped_scenes(std::string_view folder);
// Returns the path of such a folder ("shaders"), or an empty text if there is none.
[[nodiscard]] std::string shipped_folder(std::string_view folder);

// Returns $XDG_STATE_HOME/tyndall/view.toml, else the same file in $HOME/.local/state, else in the working directory.
[[nodiscard]] std::string default_state_file();
// Creates the folder of a file if it is missing. Returns false when that fails.
bool make_folder_of(const std::string& path);

// Returns "tyndall-20260131-235959" in a folder (empty: the working directory), with "-2", "-3" ... appended if a file
// of that name with one of the extensions exists.
[[nodiscard]] std::string screenshot_stem(const std::string& folder, const std::vector<std::string>& endings);

// first_run() returns whether the first steps have never been closed; leave_first_run_mark() notes that they have.
[[nodiscard]] bool first_run(const std::string& state_file);
void leave_first_run_mark(const std::string& state_file);

}  // namespace tyndall::viewer
