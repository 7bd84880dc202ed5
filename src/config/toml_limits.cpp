#include "config/toml_limits.hpp"

#include <algorithm>
#include <string>

#include "files/text.hpp"

namespace tyndall::config {
namespace {

// Returns the position after the string that starts at `start` with a quotation mark, or the end of the text if it does
// not end.
std::size_t end_of_string(std::string_view text, std::size_t start) {
  const char quote = text[start];
  const std::string_view triple = text.substr(start, 3);
  const bool long_form = triple.size() == 3 && triple[1] == quote && triple[2] == quote;
  std::size_t at = start + (long_form ? 3 : 1);
  while (at < text.size()) {
    if (quote == '"' && text[at] == '\\') {
      at += 2;
      continue;
    }
    if (!long_form && text[at] == '\n') return at;
    if (text[at] == quote && (!long_form || text.substr(at, 3) == triple)) return at + (long_form ? 3 : 1);
    ++at;
  }
  return text.size();
}

}  // namespace

Result<void> check_key_depth(std::string_view toml, std::string_view name) {
  int parts = 1;
  std::size_t line = 1;
  for (std::size_t at = 0; at < toml.size();) {
    const char c = toml[at];
    if (c == '"' || c == '\'') {
      const std::size_t end = std::min(end_of_string(toml, at), toml.size());
      line += static_cast<std::size_t>(std::count(toml.begin() + static_cast<std::ptrdiff_t>(at),
                                                  toml.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
      at = end;
      continue;
    }
    if (c == '#') {
      at = std::min(toml.find('\n', at), toml.size());
      continue;
    }
    if (c == '.') {
      if (++parts > kMaxKeyParts) {
        return files::input_error(files::concat({"a key of more than ", std::to_string(kMaxKeyParts), " parts"}),
                                  files::concat({files::one_line(name, 200), ":", std::to_string(line)}),
                                  "expected KEY = VALUE in [TABLES]");
      }
    } else if (c == '\n' || c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}') {
      parts = 1;
    }
    if (c == '\n') ++line;
    ++at;
  }
  return {};
}

}  // namespace tyndall::config
