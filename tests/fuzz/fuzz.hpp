// Helpers of the fuzzers. Each fuzzer reads one kind of input as the program does. A crash, a report of a sanitizer, a
// hang and a failed require() are findings.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "tyndall/result.hpp"

namespace tyndall::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// Ends the process, which libFuzzer reports as a finding, unless the condition holds.
inline void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "fuzz: not true: %s\n", what);
  std::abort();
}

// Checks that a refusal is one line of printable text.
inline void require_one_line(const Error& error) {
  require(!error.message.empty(), "the error has a message");
  for (const char c : error.message) {
    require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, "the error is one line without control characters");
  }
}

// A folder of this process for the files of an input, which is removed when the process ends.
class Folder {
 public:
  Folder() {
    std::error_code missing;
    const std::filesystem::path parent = std::filesystem::is_directory("/dev/shm", missing)
                                             ? std::filesystem::path("/dev/shm")
                                             : std::filesystem::temp_directory_path();
    std::string name = (parent / "tyndall-fuzz-XXXXXX").string();
    require(::mkdtemp(name.data()) != nullptr, "a folder for the inputs can be made");
    path_ = name;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  [[nodiscard]] std::string at(std::string_view name) const { return path_ + "/" + std::string(name); }
  // Writes a file and returns its path.
  std::string write(std::string_view name, std::string_view contents) const {
    std::string path = at(name);
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(contents.data(), static_cast<std::streamsize>(contents.size()));
    return path;
  }

 private:
  std::string path_;
};

}  // namespace tyndall::fuzz

// libFuzzer calls this for each input. Returns 0; -1 excludes an input from the corpus.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
