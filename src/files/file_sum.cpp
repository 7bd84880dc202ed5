#include "files/file_sum.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>
#include <vector>

#include "files/text.hpp"

// The functions of xxHash are inline, so that no library is needed.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace tyndall::files {

Result<FileSum> sum_of_file(const std::string& path) {
  const auto error = [&](int code) {
    return Error{ErrorCode::io, concat({"'", one_line(path, 200), "': cannot read: ",
                                        std::generic_category().message(code), "; expected a readable file"})};
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rbe"));
  if (file == nullptr) return error(errno);
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  FileSum sum;
  std::vector<char> piece(std::size_t{1} << 18U);
  for (;;) {
    const std::size_t got = std::fread(piece.data(), 1, piece.size(), file.get());
    if (got > 0) XXH3_64bits_update(&state, piece.data(), got);
    sum.bytes += got;
    if (got < piece.size()) break;
  }
  if (std::ferror(file.get()) != 0) return error(errno != 0 ? errno : EIO);
  sum.checksum = hexadecimal(XXH3_64bits_digest(&state));
  return sum;
}

std::string checksum_text(std::string_view text) { return hexadecimal(XXH3_64bits(text.data(), text.size())); }

}  // namespace tyndall::files
