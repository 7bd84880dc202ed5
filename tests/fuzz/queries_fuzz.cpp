// The tables of `probe`: CSV in, the same columns and the answers out, which can be read again.
#include "probe_table.hpp"

#include <cmath>

#include "fuzz.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tyndall;
  static const fuzz::Folder folder;
  const Result<cli::ProbeTable> table = cli::read_queries(folder.write("q.csv", fuzz::text_of(data, size)));
  if (!table) {
    fuzz::require_one_line(table.error());
    return 0;
  }
  for (const RayQuery& query : table.value().queries) {
    fuzz::require(std::isfinite(query.altitude_m) && std::isfinite(query.view_zenith_rad) &&
                      std::isfinite(query.sun_zenith_rad) && std::isfinite(query.azimuth_rad),
                  "a query is finite");
  }
  const std::vector<cli::ProbeAnswer> answers(table.value().queries.size());
  const std::string written = cli::answers_as_csv(table.value(), answers, {.errors = true, .xyz = true});
  const Result<cli::ProbeTable> again = cli::read_queries(folder.write("r.csv", written));
  fuzz::require(again.ok(), "a written table is read again");
  fuzz::require(again.value().queries.size() == answers.size(), "a written table has the same rows");
  return 0;
}
