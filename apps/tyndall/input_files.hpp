// The input files of a run, which it must not overwrite.
#pragma once

#include <string>
#include <vector>

#include "cli.hpp"

namespace tyndall::cli {

struct InputFile {
  std::string name;  // name for messages: "the scene file", "terrain.source", "A"
  std::string path;
};

// Returns the files that the settings of a run name: the scene file, terrain.source, meshes.source, the buffers and
// images that a glTF file refers to, and the files that an elevation file refers to. Call after resolve().
[[nodiscard]] std::vector<InputFile> input_files(const CommonOptions& options);

// Returns an error if writing to `path` would replace one of `inputs`, which is decided by device and inode, not by
// name. `option` names the output in the error ("-o"). Outputs that do not exist yet are accepted.
[[nodiscard]] Result<void> check_not_input(const std::string& path, std::string_view option,
                                           const std::vector<InputFile>& inputs);

}  // namespace tyndall::cli
