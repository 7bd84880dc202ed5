#include "merge_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "files/csv.hpp"
#include "files/text.hpp"

namespace tyndall::cli {
namespace {

using files::concat;
using files::input_error;

constexpr std::string_view kExpected = "expected tables of the same queries that probe wrote";

std::string line_of(const std::vector<std::string_view>& fields) {
  std::string out;
  for (std::size_t i = 0; i < fields.size(); ++i) out.append(i > 0 ? "," : "").append(fields[i]);
  return out + "\n";
}

// The mean of a column over tables, or its standard error.
enum class Kind { other, mean, error };

Kind kind_of(std::string_view name) {
  constexpr std::array<std::string_view, 6> kMeans = {"L_r", "L_g", "L_b", "X", "Y", "Z"};
  constexpr std::array<std::string_view, 3> kErrors = {"stderr_r", "stderr_g", "stderr_b"};
  if (std::find(kMeans.begin(), kMeans.end(), name) != kMeans.end()) return Kind::mean;
  return std::find(kErrors.begin(), kErrors.end(), name) != kErrors.end() ? Kind::error : Kind::other;
}

// Reads a number; the standard error of a single block of paths is "inf".
Result<double> number_of(std::string_view field, Kind kind, const EstimateTable& table, std::size_t line) {
  const std::string text = files::csv_value(field);
  double value = 0.0;
  if (files::read_number(text, value) == files::NumberError::none) return value;
  if (text == "inf" && kind == Kind::error) return INFINITY;
  return input_error(concat({"'", files::one_line(text), "' is not a number"}),
                     concat({files::one_line(table.name, 200), ":", std::to_string(line)}), kExpected);
}

}  // namespace

Result<std::string> join_rows(std::vector<ShardTable> shards) {
  if (shards.size() == 1) return std::move(shards[0].text);
  std::vector<files::CsvTable> tables;
  std::size_t rows = 0;
  for (ShardTable& shard : shards) {
    Result<files::CsvTable> table = files::parse_csv(std::move(shard.text), files::one_line(shard.name, 200));
    if (!table) return std::move(table).error();
    tables.push_back(std::move(table).value());
    if (tables.back().header != tables[0].header)
      return input_error("the columns are other ones", files::one_line(shard.name, 200), kExpected);
    rows += tables.back().rows();
  }
  std::string out = line_of(tables[0].header);
  for (std::size_t row = 0; row < rows; ++row) {
    const files::CsvTable& table = tables[row % tables.size()];
    const std::size_t at = row / tables.size();
    if (at >= table.rows()) {
      return input_error("rows are missing", files::one_line(shards[row % tables.size()].name, 200), kExpected);
    }
    for (std::size_t i = 0; i < table.header.size(); ++i) out.append(i > 0 ? "," : "").append(table.field(at, i));
    out += '\n';
  }
  return out;
}

Result<std::string> combine_estimates(const std::vector<EstimateTable>& tables) {
  std::vector<files::CsvTable> parsed;
  double paths = 0.0;
  for (const EstimateTable& table : tables) {
    Result<files::CsvTable> read = files::parse_csv(table.text, files::one_line(table.name, 200));
    if (!read) return std::move(read).error();
    parsed.push_back(std::move(read).value());
    paths += static_cast<double>(table.paths);
    if (parsed.back().header != parsed[0].header || parsed.back().rows() != parsed[0].rows())
      return input_error("the columns or rows are other ones", files::one_line(table.name, 200), kExpected);
  }
  const files::CsvTable& first = parsed[0];
  std::string out = line_of(first.header);
  for (std::size_t row = 0; row < first.rows(); ++row) {
    for (std::size_t column = 0; column < first.header.size(); ++column) {
      if (column > 0) out += ',';
      const Kind kind = kind_of(files::csv_value(first.header[column]));
      double sum = 0.0;
      for (std::size_t t = 0; t < parsed.size(); ++t) {
        const std::string_view field = parsed[t].field(row, column);
        if (kind == Kind::other) {
          if (field != first.field(row, column)) {
            return input_error(
                "a query or transmittance is another one",
                concat({files::one_line(tables[t].name, 200), ":", std::to_string(parsed[t].lines[row])}), kExpected);
          }
          continue;
        }
        const Result<double> value = number_of(field, kind, tables[t], parsed[t].lines[row]);
        if (!value) return value.error();
        const double weight = static_cast<double>(tables[t].paths) / paths;
        sum += kind == Kind::mean ? weight * value.value() : weight * weight * value.value() * value.value();
      }
      out += kind == Kind::other  ? std::string(first.field(row, column))
             : kind == Kind::mean ? files::number_text(sum)
                                  : files::number_text(std::sqrt(sum));
    }
    out += '\n';
  }
  return out;
}

}  // namespace tyndall::cli
