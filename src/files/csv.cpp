// Parses in one pass, and character by character only inside quotes.
#include "files/csv.hpp"

#include <algorithm>

#include "files/text.hpp"

namespace tyndall::files {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

class Reader {
 public:
  Reader(std::string_view text, std::string_view name) : text_(text), name_(name) {}

  [[nodiscard]] bool at_end() const { return position_ >= text_.size(); }
  [[nodiscard]] std::size_t line() const { return line_; }

  // Appends the fields of the next record. A blank line has none.
  Result<void> record(std::vector<std::string_view>& fields) {
    if (skip_blank_line()) return {};
    for (;;) {
      const std::size_t start = position_;
      if (Result<void> passed = pass_quoted(); !passed) return passed;
      position_ = std::min(text_.find_first_of(",\n", position_), text_.size());
      std::string_view field = text_.substr(start, position_ - start);
      const bool last = at_end() || text_[position_] == '\n';
      if (last && field.ends_with('\r')) field.remove_suffix(1);
      fields.push_back(field);
      if (!at_end()) ++position_;
      if (last) break;
    }
    ++line_;
    return {};
  }

 private:
  bool skip_blank_line() {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    if (text_.substr(position_, end - position_).find_first_not_of(" \t\r") != std::string_view::npos) {
      return false;
    }
    position_ = end + 1;
    ++line_;
    return true;
  }

  // Moves past the closing quote of a quoted field; does nothing when the field is not quoted.
  Result<void> pass_quoted() {
    const std::size_t first = text_.find_first_not_of(" \t", position_);
    if (first == std::string_view::npos || text_[first] != '"') return {};
    const std::string where = concat({name_, ":", std::to_string(line_)});
    position_ = first + 1;
    for (;;) {
      const std::size_t quote = text_.find('"', position_);
      if (quote == std::string_view::npos) {
        return input_error("a quoted field does not end", where, "expected a closing '\"'");
      }
      line_ += static_cast<std::size_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(position_),
                                                   text_.begin() + static_cast<std::ptrdiff_t>(quote), '\n'));
      position_ = quote + 1;
      if (at_end() || text_[position_] != '"') break;
      ++position_;  // two quotes stand for one
    }
    const std::size_t next = text_.find_first_not_of(" \t\r", position_);
    if (next != std::string_view::npos && text_[next] != ',' && text_[next] != '\n') {
      return input_error("text after a closing quote", where, "expected a comma or the end of the line");
    }
    return {};
  }

  std::string_view text_;
  std::string_view name_;
  std::size_t position_ = 0;
  std::size_t line_ = 1;
};

}  // namespace

std::vector<std::size_t> CsvTable::find(std::string_view name) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (csv_value(header[i]) == name) found.push_back(i);
  }
  return found;
}

std::string csv_value(std::string_view field) {
  field = trimmed(field);
  if (field.size() < 2 || field.front() != '"' || field.back() != '"') return std::string(field);
  std::string out;
  for (std::size_t i = 1; i + 1 < field.size(); ++i) {
    out += field[i];
    if (field[i] == '"') ++i;
  }
  return std::string(trimmed(out));
}

Result<CsvTable> parse_csv(std::string text, std::string_view name) {
  CsvTable table;
  table.text = std::make_unique<const std::string>(std::move(text));
  std::string_view rest = *table.text;
  if (rest.find('\0') != std::string_view::npos) {
    return input_error("not a text file", name, "expected comma-separated text");
  }
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  Reader reader(rest, name);
  while (!reader.at_end() && table.header.empty()) {
    if (Result<void> read = reader.record(table.header); !read) return std::move(read).error();
  }
  if (table.header.empty()) {
    return input_error("no header line", name, "expected a line with the names of the columns");
  }
  while (!reader.at_end()) {
    const std::size_t before = table.fields.size();
    const std::size_t line = reader.line();
    if (Result<void> read = reader.record(table.fields); !read) return std::move(read).error();
    const std::size_t count = table.fields.size() - before;
    if (count == 0) continue;
    if (count != table.header.size()) {
      return input_error(concat({std::to_string(count), count == 1 ? " field" : " fields"}),
                         concat({name, ":", std::to_string(line)}),
                         concat({"expected ", std::to_string(table.header.size()), ", as in the header"}));
    }
    table.lines.push_back(line);
  }
  return table;
}

}  // namespace tyndall::files
