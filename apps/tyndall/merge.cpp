// `tyndall merge`: combines the results of shards. docs/batch.md.
#include "arguments.hpp"
#include "cli.hpp"
#include "merge_shards.hpp"

namespace tyndall::cli {

int run_merge(Args args) {
  std::string output;
  std::vector<std::string> paths;
  Arguments arguments("merge");
  arguments.positional("OUT", output, true,
                       "a table for shards of probe, a report (.html, .md, .json) for validate, a manifest (.json) for "
                       "render and sky");
  arguments.rest("IN", paths, "the manifests of all shards, OUT.shard-I-of-N.json");
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  const Result<void> merged = merge_shards(output, paths, [] { return validate_models({}, {}, {}); });
  return merged ? kDone : fail(merged.error());
}

}  // namespace tyndall::cli
