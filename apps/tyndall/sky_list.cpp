#include "sky_list.hpp"

#include <algorithm>
#include <array>

#include "cli.hpp"
#include "files/csv.hpp"
#include "files/file_sum.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "scene/description/solar_position.hpp"

namespace tyndall::cli {
namespace {

using files::concat;
using files::input_error;

constexpr std::uint64_t kLargestList = std::uint64_t{1} << 28U;  // bytes
constexpr std::size_t kMaxSkies = 1000000;                       // as many as frames of `render`

enum SkyColumn : std::size_t { kLatitude, kLongitude, kTime, kSunElevation, kSunAzimuth, kName, kSkyColumnCount };
constexpr std::array<std::string_view, kSkyColumnCount> kSkyColumns = {"latitude_deg",      "longitude_deg",   "time",
                                                                       "sun_elevation_deg", "sun_azimuth_deg", "name"};
constexpr std::string_view kNeeded =
    "expected latitude_deg, longitude_deg, time or sun_elevation_deg, sun_azimuth_deg, and optionally name";
constexpr std::size_t kMissing = SIZE_MAX;

struct List {
  files::CsvTable table;
  std::array<std::size_t, kSkyColumnCount> at = {};  // indices of the columns; kMissing for those that are not there
  std::string shown;                                 // name of the file for messages

  [[nodiscard]] std::string cell(std::size_t row, SkyColumn column) const {
    return files::csv_value(table.field(row, at[column]));
  }
  [[nodiscard]] std::string where(std::size_t row, std::string_view column) const {
    return concat({shown, ":", std::to_string(table.lines[row]), ": column '", column, "'"});
  }
};

// Finds the columns, and checks that they are those of one kind of list.
Result<void> find_columns(List& list) {
  list.at.fill(kMissing);
  for (std::size_t i = 0; i < list.table.header.size(); ++i) {
    const std::string name = files::csv_value(list.table.header[i]);
    const auto* const known = std::find(kSkyColumns.begin(), kSkyColumns.end(), name);
    if (known == kSkyColumns.end())
      return input_error(concat({"unknown column '", files::one_line(name), "'"}), list.shown, kNeeded);
    std::size_t& place = list.at[static_cast<std::size_t>(known - kSkyColumns.begin())];
    if (place != kMissing)
      return input_error(concat({"several columns '", name, "'"}), list.shown, concat({kNeeded, ", once each"}));
    place = i;
  }
  const auto has = [&](SkyColumn column) { return list.at[column] != kMissing; };
  const bool any_place = has(kLatitude) || has(kLongitude) || has(kTime);
  const bool any_angle = has(kSunElevation) || has(kSunAzimuth);
  if (any_place && any_angle)
    return input_error("the sun is given both by angles and by place and time", list.shown, kNeeded);
  for (std::size_t i = any_angle ? kSunElevation : kLatitude; i < (any_angle ? kName : kSunElevation); ++i) {
    if (list.at[i] == kMissing) return input_error(concat({"no column '", kSkyColumns[i], "'"}), list.shown, kNeeded);
  }
  return {};
}

Result<SunAngles> find_sun(const List& list, std::size_t row, SkyEntry& entry, double altitude_m) {
  if (list.at[kSunElevation] != kMissing) {
    SunAngles sun;
    const auto read = [&](SkyColumn column, double limit, double& value) -> Result<void> {
      const Result<double> number =
          parse_number(list.cell(row, column), list.where(row, kSkyColumns[column]), -limit, limit);
      if (!number) return number.error();
      value = number.value();
      return {};
    };
    if (Result<void> r = read(kSunElevation, 90.0, sun.elevation_deg); !r) return std::move(r).error();
    if (Result<void> r = read(kSunAzimuth, 3600.0, sun.azimuth_deg); !r) return std::move(r).error();
    return sun;
  }
  entry.place = concat({list.cell(row, kLatitude), ",", list.cell(row, kLongitude)});
  entry.time = list.cell(row, kTime);
  const Result<scene::Place> place = scene::parse_place(entry.place, list.where(row, "latitude_deg, longitude_deg"));
  if (!place) return place.error();
  const Result<double> time = scene::parse_time(entry.time, list.where(row, "time"));
  if (!time) return time.error();
  const scene::SolarPosition position = scene::solar_position(place.value(), time.value(), altitude_m);
  return SunAngles{position.elevation_deg, position.azimuth_deg};
}

}  // namespace

std::string checksum(const SkyEntry& entry) {
  std::string text =
      concat({files::number_text(entry.sun.elevation_deg), " ", files::number_text(entry.sun.azimuth_deg)});
  for (const std::string& part : {entry.place, entry.time, entry.name}) {
    text += concat({" ", std::to_string(part.size()), ":", part});
  }
  return files::checksum_text(text);
}

Result<std::vector<SkyEntry>> read_sky_list(const std::string& path, double altitude_m) {
  List list;
  list.shown = files::one_line(path, 200);
  Result<std::string> text = files::read_file(path, kLargestList);
  // An unreadable list is bad input, not a failure at run time.
  if (!text) return Error{ErrorCode::invalid_argument, std::move(text).error().message};
  Result<files::CsvTable> parsed = files::parse_csv(std::move(text).value(), list.shown);
  if (!parsed) return std::move(parsed).error();
  list.table = std::move(parsed).value();
  if (Result<void> r = find_columns(list); !r) return std::move(r).error();
  const std::size_t rows = list.table.rows();
  if (rows == 0 || rows > kMaxSkies) {
    return input_error(concat({std::to_string(rows), " rows"}), list.shown,
                       concat({"expected 1 to ", std::to_string(kMaxSkies)}));
  }
  std::vector<SkyEntry> out;
  out.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    SkyEntry entry;
    if (list.at[kName] != kMissing) entry.name = list.cell(row, kName);
    Result<SunAngles> sun = find_sun(list, row, entry, altitude_m);
    if (!sun) return std::move(sun).error();
    entry.sun = sun.value();
    out.push_back(std::move(entry));
  }
  return out;
}

}  // namespace tyndall::cli
