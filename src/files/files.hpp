// Reads whole files, and writes files so that no other process ever sees a partly written one under the target's name.
// Errors (ErrorCode::io) are one line and name the file.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "tyndall/result.hpp"

namespace tyndall::files {

// Returns the contents of a file of at most `limit` bytes (a pipe or device: at most 256 MiB). Refuses directories.
[[nodiscard]] Result<std::string> read_file(const std::string& path, std::uint64_t limit);

// A file that appears under its name only when commit() succeeds. Destruction without commit() leaves nothing behind.
// The data goes to an unnamed file in the target's directory if the file system supports that, otherwise to a temporary
// file, which remove_leftovers() removes after a killed run. Symbolic links are followed, even to a target that does
// not exist yet; devices and pipes (/dev/stdout) are written directly. An existing file's mode is preserved where the
// file system permits. Move-only; use from one thread.
class AtomicFile {
 public:
  // Opens the file; fails when the directory is missing or the file cannot be written.
  [[nodiscard]] static Result<AtomicFile> create(const std::string& path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  [[nodiscard]] Result<void> write(const void* data, std::size_t size);
  [[nodiscard]] Result<void> write(std::string_view text) { return write(text.data(), text.size()); }
  // Sets where the next write goes, in bytes from the start.
  [[nodiscard]] Result<void> seek(std::uint64_t position);
  [[nodiscard]] Result<void> commit();

 private:
  AtomicFile() = default;
  [[nodiscard]] Error error(std::string_view what) const;  // includes the meaning of errno
  void discard();
  // Opens a named temporary file beside the target; returns false, with errno set, when none can be created.
  [[nodiscard]] bool open_temporary();
  // Copies an unnamed file that cannot be linked into a named temporary file.
  [[nodiscard]] bool copy_to_named();

  int descriptor_ = -1;
  std::string shown_;           // the caller's name for the file, for messages
  std::string path_;            // the target, with links resolved
  std::string temporary_;       // the name before commit; empty for nameless files and devices
  std::optional<mode_t> mode_;  // mode of the file that will be replaced
  bool nameless_ = false;
};

// Creates, writes and commits a file.
[[nodiscard]] Result<void> write_file(const std::string& path, std::string_view contents);

// Checks that a file can be written, before long work: returns the error that AtomicFile::create() would return, and
// leaves no file. Also removes leftovers beside the target.
[[nodiscard]] Result<void> check_writable(const std::string& path);

// Removes the temporary files and folders (named ".tyndall-...") of killed runs from a directory: those that are older
// than a minute and that no process has locked (flock).
void remove_leftovers(const std::string& directory);

}  // namespace tyndall::files
