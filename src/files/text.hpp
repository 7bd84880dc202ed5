// Converts numbers, names and messages to and from text, for parameter files, the command line and reports. Numbers are
// written with the fewest digits that read back to the same value; the locale has no influence. Nothing here prints,
// and nothing throws except for lack of memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tyndall/result.hpp"

namespace tyndall::files {

// Returns the shortest decimal text that reads back to the same value ("0.76", "5.8e-06", "nan", "-inf").
[[nodiscard]] std::string number_text(float value);
[[nodiscard]] std::string number_text(double value);

enum class NumberError : std::uint32_t { none, not_a_number, not_finite, too_large };

// Reads the whole of `text` (blanks around it are ignored) as a decimal number.
[[nodiscard]] NumberError read_number(std::string_view text, float& value);
[[nodiscard]] NumberError read_number(std::string_view text, double& value);
// Reads a whole number: "3.0" and "3e2" give not_a_number, and values outside the range of int64 give too_large.
[[nodiscard]] NumberError read_integer(std::string_view text, std::int64_t& value);

[[nodiscard]] std::string_view trimmed(std::string_view text);
// Count and return the parts of `text` between separators; an empty text has one empty part.
[[nodiscard]] std::size_t count_parts(std::string_view text, char separator);
[[nodiscard]] std::string_view part(std::string_view text, char separator, std::size_t index);

// Returns `text` with lower-case letters for A to Z, whatever the locale is.
[[nodiscard]] std::string lower_case(std::string_view text);

// Returns 16 hexadecimal digits.
[[nodiscard]] std::string hexadecimal(std::uint64_t value);

[[nodiscard]] bool is_utf8(std::string_view text);
// Returns whether `text` contains a byte below 0x20 or the byte 0x7f.
[[nodiscard]] bool has_control_characters(std::string_view text);

[[nodiscard]] std::string concat(std::initializer_list<std::string_view> parts);

// Returns the error of bad input, "WHERE: WHAT; EXPECTED": the source, what is wrong, and what is accepted, as in
// "expected 0 to 1" or "did you mean 'x'?".
[[nodiscard]] Error input_error(std::string_view what, std::string_view where, std::string_view expected);

// Returns `text` in a form that is safe in a message: on one line, with '?' for control characters and invalid bytes,
// and shortened to at most `limit` bytes.
[[nodiscard]] std::string one_line(std::string_view text, std::size_t limit = 80);

// Returns `text` as a JSON string, which is also a TOML basic string, with its quotes. Precondition: valid UTF-8.
[[nodiscard]] std::string quoted_text(std::string_view text);

// Returns the number of insertions, deletions, replacements and swaps of neighbours that turn a into b (Damerau 1964,
// restricted form).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

// Returns the candidate that is nearest to `name`, if it is near enough to be a typing error: 2 edits, or a third of
// the length.
[[nodiscard]] std::optional<std::string> nearest(std::string_view name, std::span<const std::string> candidates);

}  // namespace tyndall::files
