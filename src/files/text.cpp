// Number formatting and parsing through <charconv>, UTF-8 checks, edit distance.
#include "files/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <vector>

namespace tyndall::files {
namespace {

template <typename T>
std::string shortest_text(T value) {
  char buffer[64];
  const std::to_chars_result end = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, end.ptr);
}

// Removes a plus sign, which from_chars does not accept.
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  return text;
}

// Returns the power of ten of the first nonzero digit of a decimal number that from_chars accepts.
std::int64_t order_of_magnitude(std::string_view text) {
  constexpr std::int64_t kLargestExponent = std::int64_t{1} << 40;
  const std::size_t e = std::min(text.find_first_of("eE"), text.size());
  std::int64_t exponent = 0;
  bool negative = false;
  for (const char c : text.substr(std::min(e + 1, text.size()))) {
    if (c == '-') negative = true;
    if (c >= '0' && c <= '9') exponent = std::min(10 * exponent + (c - '0'), kLargestExponent);
  }
  if (negative) exponent = -exponent;
  const std::string_view digits = text.substr(0, e);
  const std::size_t point = std::min(digits.find('.'), digits.size());
  const std::size_t first = std::min(digits.find_first_of("123456789"), digits.size());
  const std::int64_t places = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
  return exponent + (first < point ? places - 1 : places);
}

template <typename T>
NumberError read_real(std::string_view text, T& value) {
  text = without_plus(trimmed(text));
  T read{};
  const std::from_chars_result end = std::from_chars(text.data(), text.data() + text.size(), read);
  if (end.ec == std::errc::invalid_argument || end.ptr != text.data() + text.size()) {
    return NumberError::not_a_number;
  }
  if (end.ec == std::errc::result_out_of_range) {
    // from_chars does not report whether the number is too large or too small. A number that is too small for T becomes
    // zero.
    if (order_of_magnitude(text) > 0) return NumberError::too_large;
    read = T{};
  }
  if (!std::isfinite(read)) return NumberError::not_finite;
  value = read;
  return NumberError::none;
}

// Returns the length of the valid UTF-8 sequence at the start of `text`, 0 when there is none.
std::size_t utf8_sequence(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80U) return 1;
  const std::size_t length = lead >= 0xF0U ? 4 : lead >= 0xE0U ? 3 : 2;
  if (lead < 0xC2U || lead > 0xF4U || text.size() < length) return 0;
  std::uint32_t code = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  const bool overlong = (length == 3 && code < 0x800U) || (length == 4 && code < 0x10000U);
  const bool surrogate = code >= 0xD800U && code <= 0xDFFFU;
  return overlong || surrogate || code > 0x10FFFFU ? 0 : length;
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20U || c == '\x7f'; }

}  // namespace

std::string number_text(float value) { return shortest_text(value); }
std::string number_text(double value) { return shortest_text(value); }

NumberError read_number(std::string_view text, float& value) { return read_real(text, value); }
NumberError read_number(std::string_view text, double& value) { return read_real(text, value); }

NumberError read_integer(std::string_view text, std::int64_t& value) {
  text = without_plus(trimmed(text));
  const std::from_chars_result end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec == std::errc::invalid_argument || end.ptr != text.data() + text.size()) {
    return NumberError::not_a_number;
  }
  return end.ec == std::errc::result_out_of_range ? NumberError::too_large : NumberError::none;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::size_t count_parts(std::string_view text, char separator) {
  return 1 + static_cast<std::size_t>(std::count(text.begin(), text.end(), separator));
}

std::string_view part(std::string_view text, char separator, std::size_t index) {
  for (; index > 0; --index) text.remove_prefix(std::min(text.find(separator), text.size() - 1) + 1);
  return text.substr(0, text.find(separator));
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_sequence(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

bool has_control_characters(std::string_view text) { return std::any_of(text.begin(), text.end(), is_control); }

std::string concat(std::initializer_list<std::string_view> parts) {
  std::size_t size = 0;
  for (const std::string_view piece : parts) size += piece.size();
  std::string text;
  text.reserve(size);
  for (const std::string_view piece : parts) text += piece;
  return text;
}

Error input_error(std::string_view what, std::string_view where, std::string_view expected) {
  return Error{ErrorCode::invalid_argument, concat({where, ": ", what, "; ", expected})};
}

std::string one_line(std::string_view text, std::size_t limit) {
  std::string line;
  while (!text.empty()) {
    const std::size_t length = utf8_sequence(text);
    if (line.size() + std::max<std::size_t>(length, 1) > limit) return line + "...";
    if (length == 0 || is_control(text[0])) {
      line += '?';
    } else {
      line += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return line;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

std::string hexadecimal(std::uint64_t value) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out(16, '0');
  for (std::size_t i = out.size(); i-- > 0; value >>= 4U) out[i] = kDigits[value & 15U];
  return out;
}

std::string quoted_text(std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (is_control(c)) {
      const unsigned code = static_cast<unsigned char>(c);
      out += "\\u00";
      out += kHex[code >> 4U];
      out += kHex[code & 15U];
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the dynamic programming table: the current one and the two above.
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = above;
    above = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replace, above[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
  }
  return row[b.size()];
}

std::optional<std::string> nearest(std::string_view name, std::span<const std::string> candidates) {
  constexpr std::size_t kLongestName = 200;  // the time grows with the product of the lengths
  if (name.empty() || name.size() > kLongestName) return std::nullopt;
  std::size_t best = std::max<std::size_t>(2, name.size() / 3) + 1;
  std::optional<std::string> found;
  for (const std::string& candidate : candidates) {
    // The distance is at least the difference of the lengths.
    const std::size_t longer = std::max(name.size(), candidate.size()) - std::min(name.size(), candidate.size());
    if (longer >= best) continue;
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best && distance < candidate.size()) {
      best = distance;
      found = candidate;
    }
  }
  return found;
}

}  // namespace tyndall::files
