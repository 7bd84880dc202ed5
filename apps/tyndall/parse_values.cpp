// Implements the parsing of values in cli.hpp.
#include "cli.hpp"
#include "files/text.hpp"

namespace tyndall::cli {
namespace {

using files::concat;
using files::input_error;

std::string shown(std::string_view text) { return concat({"'", files::one_line(text), "'"}); }

}  // namespace

Result<Size> parse_size(std::string_view text, std::string_view option) {
  std::int64_t width = 0;
  std::int64_t height = 0;
  const auto fits = [](std::int64_t side) { return side >= 1 && side <= kLargestSize; };
  const bool valid = files::count_parts(text, 'x') == 2 &&
                     files::read_integer(files::part(text, 'x', 0), width) == files::NumberError::none &&
                     files::read_integer(files::part(text, 'x', 1), height) == files::NumberError::none &&
                     fits(width) && fits(height);
  if (valid) return Size{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  return input_error(concat({"invalid size ", shown(text)}), option,
                     concat({"expected WIDTHxHEIGHT, each 1 to ", std::to_string(kLargestSize)}));
}

Result<std::uint32_t> parse_count(std::string_view text, std::string_view option, std::uint32_t min,
                                  std::uint32_t max) {
  std::int64_t value = 0;
  if (files::read_integer(text, value) == files::NumberError::none && value >= min && value <= max) {
    return static_cast<std::uint32_t>(value);
  }
  return input_error(concat({"invalid count ", shown(text)}), option,
                     concat({"expected a whole number, ", std::to_string(min), " to ", std::to_string(max)}));
}

Result<double> parse_number(std::string_view text, std::string_view option, double min, double max) {
  double value = 0.0;
  if (files::read_number(text, value) == files::NumberError::none && value >= min && value <= max) return value;
  return input_error(concat({"invalid number ", shown(text)}), option,
                     concat({"expected a number, ", files::number_text(min), " to ", files::number_text(max)}));
}

}  // namespace tyndall::cli
