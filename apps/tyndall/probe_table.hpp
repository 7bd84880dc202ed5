// The tables of `probe`: queries in, the same columns and the answers out.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "files/csv.hpp"
#include "probe_models.hpp"

namespace tyndall::cli {

struct ProbeTable {
  files::CsvTable input;
  std::vector<RayQuery> queries;  // one per row
};

// Every mistake in the file is bad input, and named by line and column.
[[nodiscard]] Result<ProbeTable> read_queries(const std::string& path);

// The input's columns as they were written, then those of the answers; columns of the input with such a
// name, as in a table that `probe` has written, give way.
[[nodiscard]] std::string answers_as_csv(const ProbeTable& table, std::span<const ProbeAnswer> answers, bool random);

}  // namespace tyndall::cli
