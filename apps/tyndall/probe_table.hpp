// The tables of `probe`: queries in, the same columns and the results out.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "files/csv.hpp"
#include "probe_models.hpp"
#include "shard.hpp"

namespace tyndall::cli {

struct ProbeTable {
  files::CsvTable input;
  std::vector<RayQuery> queries;  // one per row
};

// Reads the queries. Every mistake in the file is bad input; the error names line and column.
[[nodiscard]] Result<ProbeTable> read_queries(const std::string& path);

// Removes the rows that do not belong to the shard.
void select_rows(ProbeTable& table, const Shard& shard);

// Returns the input's columns unchanged, followed by the result columns. Input columns with the name of a result
// column, as in a table that `probe` has written, are dropped.
struct AnswerColumns {
  bool errors = false;  // stderr_r, stderr_g, stderr_b
  bool xyz = false;     // X, Y, Z
};
[[nodiscard]] std::string answers_as_csv(const ProbeTable& table, std::span<const ProbeAnswer> answers,
                                         AnswerColumns with);

}  // namespace tyndall::cli
