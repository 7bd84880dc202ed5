// Tables of comma-separated values (RFC 4180): a header line, then rows with one field for each of its columns. Fields
// are views of the text as written, with their quotes, so that columns can be copied to the output unchanged. A byte
// order mark, CRLF line ends, blank lines and a last row without a line end are accepted.
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
  std::unique_ptr<const std::string> text;  // owns the characters of the views below
  std::vector<std::string_view> header;     // as written, with quotes
  std::vector<std::string_view> fields;     // row after row
  std::vector<std::size_t> lines;           // line number of the start of each row, from 1

  [[nodiscard]] std::size_t rows() const { return lines.size(); }
  [[nodiscard]] std::string_view field(std::size_t row, std::size_t column) const {
    return fields[row * header.size() + column];
  }
  // Returns the indices of the columns with this name.
  [[nodiscard]] std::vector<std::size_t> find(std::string_view name) const;
};

// Parses a table. Errors call the text `name`.
[[nodiscard]] Result<CsvTable> parse_csv(std::string text, std::string_view name);

// Returns the value of a field: without its quotes and without the blanks around it.
[[nodiscard]] std::string csv_value(std::string_view field);

}  // namespace tyndall::files
