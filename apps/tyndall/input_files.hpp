// The files that a run reads, so that it does not write over one of them.
#pragma once

#include <string>
#include <vector>

#include "cli.hpp"

namespace tyndall::cli {

struct InputFile {
  std::string name;  // what it is in messages: "the scene file", "terrain.source", "A"
  std::string path;
};

// The files that the settings of a run name: the scene file, terrain.source, meshes.source, and the buffers and images
// that a glTF file refers to. Call after resolve().
[[nodiscard]] std::vector<InputFile> input_files(const CommonOptions& options);

// Returns an error when writing to `path` would replace one of `inputs`: the same device and inode, whatever the names
// are. `option` names the output in the error ("-o"). Outputs that do not exist yet are fine.
[[nodiscard]] Result<void> check_not_input(const std::string& path, std::string_view option,
                                           const std::vector<InputFile>& inputs);

}  // namespace tyndall::cli
