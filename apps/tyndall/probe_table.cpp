#include "probe_table.hpp"

#include <algorithm>
#include <optional>

#include "cli.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "math/angles.hpp"

namespace tyndall::cli {
namespace {

using files::concat;
using files::input_error;

constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 31U;  // bytes; about ten million rays
constexpr std::string_view kSky = "sky";

struct Column {
  std::string_view name;
  double min, max;
  std::string_view unit;
};
enum ColumnIndex : std::size_t { kAltitude, kViewZenith, kSunZenith, kAzimuth, kColumnCount };
constexpr Column kColumns[kColumnCount] = {
    {"altitude_m", kLowestAltitude_m, 1.0e9, "m"},
    {"view_zenith_deg", 0.0, 180.0, "deg, or sky"},
    {"sun_zenith_deg", 0.0, 180.0, "deg"},
    {"azimuth_deg", -360.0, 360.0, "deg"},
};
constexpr std::string_view kLightColumns[] = {"L_r", "L_g", "L_b", "T_r", "T_g", "T_b"};
constexpr std::string_view kErrorColumns[] = {"stderr_r", "stderr_g", "stderr_b"};
constexpr std::string_view kXyzColumns[] = {"X", "Y", "Z"};

// Returns whether a column of the input has the name of a column that is added.
bool is_answer_column(std::string_view name) {
  const auto in = [&](std::span<const std::string_view> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return in(kLightColumns) || in(kErrorColumns) || in(kXyzColumns);
}

std::string allowed_text(const Column& column) {
  return concat(
      {"expected ", files::number_text(column.min), " to ", files::number_text(column.max), " ", column.unit});
}

Result<double> read_cell(std::string_view field, const Column& column, std::string_view where) {
  const std::string text = files::csv_value(field);
  double value = 0.0;
  const files::NumberError read = files::read_number(text, value);
  if (read == files::NumberError::none && value >= column.min && value <= column.max) return value;
  const char* const what = read == files::NumberError::none || read == files::NumberError::too_large
                               ? "' is out of range"
                           : read == files::NumberError::not_finite ? "' is not a finite number"
                                                                    : "' is not a number";
  return input_error(concat({"'", files::one_line(text), what}), where, allowed_text(column));
}

Result<std::size_t> find_column(const files::CsvTable& table, const Column& column, const std::string& path) {
  const std::vector<std::size_t> found = table.find(column.name);
  if (found.size() == 1) return found.front();
  const std::string needed =
      concat({"expected ", kColumns[0].name, ", ", kColumns[1].name, ", ", kColumns[2].name, ", ", kColumns[3].name});
  return input_error(concat({found.empty() ? "no column '" : "several columns '", column.name, "'"}),
                     files::one_line(path, 200), concat({needed, found.empty() ? "" : ", once each"}));
}

void append_numbers(std::string& out, const std::array<double, 3>& numbers, bool single_precision) {
  for (const double number : numbers) {
    out += ',';
    out += single_precision ? files::number_text(static_cast<float>(number)) : files::number_text(number);
  }
}

}  // namespace

Result<ProbeTable> read_queries(const std::string& path) {
  const std::string shown = files::one_line(path, 200);
  Result<std::string> text = files::read_file(path, kLargestFile);
  // An unreadable table is bad input, not a failure at run time.
  if (!text) return Error{ErrorCode::invalid_argument, std::move(text).error().message};
  Result<files::CsvTable> parsed = files::parse_csv(std::move(text).value(), shown);
  if (!parsed) return std::move(parsed).error();
  ProbeTable table = {std::move(parsed).value(), {}};
  std::array<std::size_t, kColumnCount> at = {};
  for (std::size_t i = 0; i < kColumnCount; ++i) {
    const Result<std::size_t> found = find_column(table.input, kColumns[i], path);
    if (!found) return found.error();
    at[i] = found.value();
  }
  table.queries.reserve(table.input.rows());
  for (std::size_t row = 0; row < table.input.rows(); ++row) {
    const auto cell = [&](ColumnIndex column) { return table.input.field(row, at[column]); };
    RayQuery query;
    query.sky_irradiance = files::csv_value(cell(kViewZenith)) == kSky;
    std::array<double, kColumnCount> numbers = {};
    for (const ColumnIndex column : {kAltitude, kViewZenith, kSunZenith, kAzimuth}) {
      // The sky's irradiance has no view direction.
      if (query.sky_irradiance &&
          (column == kViewZenith || (column == kAzimuth && files::csv_value(cell(column)).empty()))) {
        continue;
      }
      double& number = numbers[column];
      // Composing the location takes longer than parsing the number, so it is done only for errors.
      const Result<double> quick = read_cell(cell(column), kColumns[column], {});
      if (!quick) {
        const std::string where =
            concat({shown, ":", std::to_string(table.input.lines[row]), ": column '", kColumns[column].name, "'"});
        return read_cell(cell(column), kColumns[column], where).error();
      }
      number = quick.value();
    }
    query.altitude_m = numbers[kAltitude];
    query.view_zenith_rad = numbers[kViewZenith] * kRadPerDeg;
    query.sun_zenith_rad = numbers[kSunZenith] * kRadPerDeg;
    query.azimuth_rad = numbers[kAzimuth] * kRadPerDeg;
    table.queries.push_back(query);
  }
  return table;
}

void select_rows(ProbeTable& table, const Shard& shard) {
  ProbeTable chosen;
  const std::size_t columns = table.input.header.size();
  for (const std::uint64_t row : shard.items(table.input.rows())) {
    for (std::size_t i = 0; i < columns; ++i) chosen.input.fields.push_back(table.input.field(row, i));
    chosen.input.lines.push_back(table.input.lines[row]);
    chosen.queries.push_back(table.queries[row]);
  }
  table.input.fields = std::move(chosen.input.fields);
  table.input.lines = std::move(chosen.input.lines);
  table.queries = std::move(chosen.queries);
}

std::string answers_as_csv(const ProbeTable& table, std::span<const ProbeAnswer> answers, AnswerColumns with) {
  std::vector<std::size_t> columns;
  for (std::size_t i = 0; i < table.input.header.size(); ++i) {
    const std::string name = files::csv_value(table.input.header[i]);
    if (!is_answer_column(name)) columns.push_back(i);
  }
  std::string out;
  for (std::size_t k = 0; k < columns.size(); ++k) out.append(k > 0 ? "," : "").append(table.input.header[columns[k]]);
  const auto append_names = [&](std::span<const std::string_view> names) {
    for (const std::string_view name : names) out.append(",").append(name);
  };
  append_names(kLightColumns);
  if (with.errors) append_names(kErrorColumns);
  if (with.xyz) append_names(kXyzColumns);
  out += '\n';
  for (std::size_t row = 0; row < table.input.rows(); ++row) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (k > 0) out += ',';
      out += table.input.field(row, columns[k]);
    }
    const ProbeAnswer& answer = answers[row];
    append_numbers(out, answer.radiance, answer.single_precision);
    append_numbers(out, answer.transmittance, answer.single_precision);
    if (with.errors) append_numbers(out, answer.standard_error, answer.single_precision);
    if (with.xyz) append_numbers(out, answer.xyz, answer.single_precision);
    out += '\n';
  }
  return out;
}

}  // namespace tyndall::cli
