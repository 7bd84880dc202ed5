// The size and checksum of a file, which show whether it is still as it was written.
#pragma once

#include <cstdint>
#include <string>

#include "tyndall/result.hpp"

namespace tyndall::files {

struct FileSum {
  std::uint64_t bytes = 0;
  std::string checksum;  // XXH3 with 64 bits, as 16 hexadecimal digits

  friend bool operator==(const FileSum&, const FileSum&) = default;
};

// Reads a file of any size in pieces. Errors (io) name the file.
[[nodiscard]] Result<FileSum> sum_of_file(const std::string& path);

// Returns the checksum of a text in the same form.
[[nodiscard]] std::string checksum_text(std::string_view text);

}  // namespace tyndall::files
