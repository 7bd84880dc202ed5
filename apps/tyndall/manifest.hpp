// The manifest of a shard: a JSON file beside the output that lists the files that the shard has made, with checksums,
// and the inputs of the run. `--resume` reads it to skip finished items, and `tyndall merge` to combine shards.
// docs/batch.md describes the members.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli.hpp"
#include "files/file_sum.hpp"
#include "shard.hpp"

namespace tyndall::cli {

// Names and values that determine the results of a run: the parameters, the options of the verb, and the checksums of
// input files.
using Inputs = std::vector<std::pair<std::string, std::string>>;
// The value of an input that can be read only once, which Batch::begin() refuses because its contents cannot be
// compared.
inline constexpr std::string_view kStream = "<stream>";

struct ManifestFile {
  std::string name;  // relative to the folder of the manifest
  files::FileSum sum;
};

struct ManifestItem {
  std::uint64_t number = 0;  // number of the frame or map; for probe and validate, number of the shard from 0
  std::string name;          // from the list of skies; may be empty
  std::vector<ManifestFile> files;
  double seconds = 0.0;
  std::string inputs_hash = {};  // checksum of the item's row of the list; may be empty
};

struct Manifest {
  std::string verb, version, device;
  std::string time;    // when the manifest was written, in UTC
  std::string output;  // as given with -o, without its folder
  Shard shard;
  std::uint64_t total = 0;  // frames, maps, rows or rays of all shards
  bool complete = false;    // everything of this shard has been made
  Inputs inputs;
  std::vector<ManifestItem> items;  // ordered by number, each once

  [[nodiscard]] std::string inputs_hash() const;
  // Returns the value of an input; an empty text if there is none.
  [[nodiscard]] std::string input(std::string_view name) const;
};

// Returns "OUT.shard-I-of-N.json".
[[nodiscard]] std::string manifest_path(const std::string& output, const Shard& shard);
// Returns "OUT.shard-I-of-NENDING", the file of a shard of `probe` or `validate`; with one shard, OUT itself.
[[nodiscard]] std::string shard_path(const std::string& output, const Shard& shard, const std::string& ending);

[[nodiscard]] std::string to_json(const Manifest& manifest);
// Errors (invalid_argument) call the text `name`.
[[nodiscard]] Result<Manifest> parse_manifest(std::string_view text, std::string_view name);
[[nodiscard]] Result<Manifest> read_manifest(const std::string& path);

// Returns the name of a file relative to a folder; the empty folder is the working directory.
[[nodiscard]] std::string relative_name(const std::string& path, const std::string& folder);

// Returns whether a file is there as the manifest in `folder` records it.
[[nodiscard]] bool is_whole(const ManifestFile& file, const std::string& folder);

// Returns the first name with different values, or that only one of them has; an empty text if they are equal.
[[nodiscard]] std::string first_difference(const Inputs& a, const Inputs& b);

// Returns the inputs that all verbs have: the version, all parameters except those that do not change results, the
// camera path, and the checksums of the files that they name. Call after resolve().
[[nodiscard]] Inputs common_inputs(const CommonOptions& options);
// Adds a name with the checksum of a file. An unreadable file has the value "unreadable", and a pipe or a device the
// value kStream.
void add_file(Inputs& inputs, const std::string& name, const std::string& path);

}  // namespace tyndall::cli
