// Files as wholes: read at once, written so that nothing half-written is ever seen under the target's
// name. Both return one-line errors (ErrorCode::io) that name the file.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "tyndall/result.hpp"

namespace tyndall::files {

// The bytes of a file of at most `limit` bytes (of a pipe or device: at most 256 MiB). Refuses directories.
[[nodiscard]] Result<std::string> read_file(const std::string& path, std::uint64_t limit);

// A file that appears under its name only when commit() succeeds; until then, and on destruction
// without commit(), nothing remains. The data goes to a nameless file in the target's directory
// where the file system has such, otherwise to a temporary file there, which remove_leftovers() removes if the
// process is killed. Symbolic links are followed, also to a target that does not exist yet; devices and pipes
// (/dev/stdout) are written directly. An existing file's mode is kept where the file system permits it.
// Move-only, one thread.
class AtomicFile {
 public:
  // Fails when the directory is missing, or the file cannot be written.
  [[nodiscard]] static Result<AtomicFile> create(const std::string& path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  [[nodiscard]] Result<void> write(const void* data, std::size_t size);
  [[nodiscard]] Result<void> write(std::string_view text) { return write(text.data(), text.size()); }
  // Where the next write goes, in bytes from the start.
  [[nodiscard]] Result<void> seek(std::uint64_t position);
  [[nodiscard]] Result<void> commit();

 private:
  AtomicFile() = default;
  [[nodiscard]] Error error(std::string_view what) const;  // with the meaning of errno
  void discard();
  // Opens a named temporary file beside the target; false (with errno) when none can be made.
  [[nodiscard]] bool open_temporary();
  // Copies a nameless file that cannot be linked to a named temporary file.
  [[nodiscard]] bool copy_to_named();

  int descriptor_ = -1;
  std::string shown_;           // as the caller named it, for messages
  std::string path_;            // where it goes, links followed
  std::string temporary_;       // the name before commit; empty for nameless files and devices
  std::optional<mode_t> mode_;  // of the file that is replaced
  bool nameless_ = false;
};

// create(), write() and commit() in one.
[[nodiscard]] Result<void> write_file(const std::string& path, std::string_view contents);

// Returns the error that create() would return, and leaves no file: for a check before long work. Also removes
// leftovers beside the target.
[[nodiscard]] Result<void> check_writable(const std::string& path);

// Removes the temporary files and folders (named ".tyndall-...") of killed runs from `directory`: those that are
// older than a minute and whose lock (flock) nobody holds.
void remove_leftovers(const std::string& directory);

}  // namespace tyndall::files
