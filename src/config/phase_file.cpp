#include "config/phase_file.hpp"

#include <vector>

#include "files/csv.hpp"
#include "files/files.hpp"
#include "files/text.hpp"

namespace tyndall::config {
namespace {

constexpr std::uint64_t kLargestPhaseFile = std::uint64_t{1} << 24U;  // bytes
constexpr std::string_view kKey = "atmosphere.phase_table";

std::string place(std::string_view where, std::string_view path, std::size_t line) {
  return files::concat({where, ": ", files::one_line(path, 200), ":", std::to_string(line)});
}

}  // namespace

Result<std::shared_ptr<const PhaseTable>> read_phase_table(const std::string& path, std::string_view where) {
  Result<std::string> text = files::read_file(path, kLargestPhaseFile);
  if (!text) {
    return Error{ErrorCode::invalid_argument, files::concat({where, ": ", std::move(text).error().message})};
  }
  Result<files::CsvTable> parsed = files::parse_csv(std::move(text).value(), files::one_line(path, 200));
  if (!parsed) {
    return Error{ErrorCode::invalid_argument, files::concat({where, ": ", std::move(parsed).error().message})};
  }
  const files::CsvTable& table = parsed.value();
  if (table.header.size() < 2 || files::csv_value(table.header[0]) != "angle_deg") {
    return files::input_error("invalid header", place(where, path, 1),
                              "expected angle_deg, and then one wavelength in nm for each further column");
  }
  std::vector<double> angles, wavelengths, values;
  for (std::size_t column = 1; column < table.header.size(); ++column) {
    const std::string name = files::csv_value(table.header[column]);
    double nm = 0.0;
    if (files::read_number(name, nm) != files::NumberError::none) {
      return files::input_error(files::concat({"invalid column '", files::one_line(name), "'"}), place(where, path, 1),
                                "expected a wavelength in nm");
    }
    wavelengths.push_back(nm);
  }
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t column = 0; column < table.header.size(); ++column) {
      const std::string field = files::csv_value(table.field(row, column));
      double number = 0.0;
      if (files::read_number(field, number) != files::NumberError::none) {
        return files::input_error(files::concat({"invalid number '", files::one_line(field), "'"}),
                                  place(where, path, table.lines[row]), "expected a number");
      }
      (column == 0 ? angles : values).push_back(number);
    }
  }
  Result<std::shared_ptr<const PhaseTable>> made = PhaseTable::create(angles, wavelengths, values);
  if (made) return made;
  return Error{ErrorCode::invalid_argument,
               files::concat({where, ": ", files::one_line(path, 200), ": ", std::move(made).error().message})};
}

Result<void> load_files(Settings& settings) {
  settings.effect.phase_table = nullptr;
  if (settings.effect.atmosphere.mie_phase != MiePhase::table) return {};
  const std::string& path = settings.scene.atmosphere.phase_table;
  if (path.empty()) {
    return files::input_error("empty value with atmosphere.mie_phase = table", kKey,
                              "expected a CSV file of angles and wavelengths");
  }
  Result<std::shared_ptr<const PhaseTable>> read = read_phase_table(path, kKey);
  if (!read) return std::move(read).error();
  settings.effect.phase_table = std::move(read).value();
  return {};
}

}  // namespace tyndall::config
