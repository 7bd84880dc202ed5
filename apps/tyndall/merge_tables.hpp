// Combines the tables that shards of `probe` have written: the rows of one run in their original order, and the
// estimates of runs of the path tracer that differ in the seed.
#pragma once

#include <string>
#include <vector>

#include "tyndall/result.hpp"

namespace tyndall::cli {

// The table of a shard.
struct ShardTable {
  std::string text;
  std::string name;  // for messages
};

// Returns the rows of all shards of a run, ordered by shard, in their original order. With one shard that is its table.
[[nodiscard]] Result<std::string> join_rows(std::vector<ShardTable> shards);

// A complete table of the path tracer.
struct EstimateTable {
  std::string text;
  std::string name;         // for messages
  std::uint64_t paths = 0;  // per row
};

// Returns the table of the means over all paths, with their standard errors. The tables have the same queries and
// independent random numbers: the mean is weighted by the numbers of paths n, and the variance of the mean is the sum
// of n^2 s^2 over the squared sum of n, where s are the standard errors.
[[nodiscard]] Result<std::string> combine_estimates(const std::vector<EstimateTable>& tables);

}  // namespace tyndall::cli
