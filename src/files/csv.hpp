// Tables of comma-separated values (RFC 4180): a header line and rows of as many fields. Fields are views of
// the text as it was written, quotes included, so that columns can be passed on unchanged. A byte order mark,
// CRLF line ends, blank lines and a missing last line end are all accepted.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tyndall/result.hpp"

namespace tyndall::files {

struct CsvTable {
  std::unique_ptr<const std::string> text;  // what the views below look at
  std::vector<std::string_view> header;     // as written
  std::vector<std::string_view> fields;     // row after row
  std::vector<std::size_t> lines;           // where each row begins, the first line of the file being 1

  [[nodiscard]] std::size_t rows() const { return lines.size(); }
  [[nodiscard]] std::string_view field(std::size_t row, std::size_t column) const {
    return fields[row * header.size() + column];
  }
  // Indices of the columns with this name.
  [[nodiscard]] std::vector<std::size_t> find(std::string_view name) const;
};

// `name` stands for the text in errors.
[[nodiscard]] Result<CsvTable> parse_csv(std::string text, std::string_view name);

// What a field says: without quotes and the blanks around it.
[[nodiscard]] std::string csv_value(std::string_view field);

}  // namespace tyndall::files
