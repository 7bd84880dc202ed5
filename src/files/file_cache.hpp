// Results that are dear to make, kept on disk between runs: one file per key in one directory. Files appear
// whole or not at all, so that any number of processes may share the directory, and are checked when they are
// read: what is truncated, damaged, of another version or of another key is as good as missing. Trouble with
// the cache never fails a run: it is told in a line. Errors and notes name files. One thread per object.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tyndall/result.hpp"

namespace tyndall::files {

class FileCache {
 public:
  // No cache: reads find nothing and writes keep nothing.
  FileCache() = default;
  // A directory, made when something is first kept. All its files together stay below `limit_bytes`: those
  // not used for longest go first. `version` tells files of this program from those of others that wrote
  // under the same keys.
  FileCache(std::string directory, std::uint64_t limit_bytes, std::string version);

  [[nodiscard]] bool enabled() const { return !directory_.empty(); }
  [[nodiscard]] const std::string& directory() const { return directory_; }

  // Whether there is a file under the key, which read() may yet refuse.
  [[nodiscard]] bool holds(std::string_view key) const;
  // What was kept under the key, if it has `size` bytes. Marks it as used.
  [[nodiscard]] std::optional<std::string> read(std::string_view key, std::uint64_t size);
  // The same, to memory of the caller's of that size: written once and in order, never read, so that memory
  // of a device will do. What it holds after `false` is not to be used.
  [[nodiscard]] bool read(std::string_view key, std::span<std::byte> to);
  // Keeps it, in place of what was there.
  void write(std::string_view key, std::span<const std::byte> contents);

  // Why the last read or write did not do what was asked: one line; empty when it did, or nothing was there.
  [[nodiscard]] const std::string& note() const { return note_; }

  // The file of a key.
  [[nodiscard]] std::string path(std::string_view key) const;

 private:
  void make_room(const std::string& kept) const;

  std::string directory_;
  std::uint64_t limit_bytes_ = 0;
  std::string version_;
  std::string note_;
};

// Where `place` is: "off" nowhere (empty), "auto" $XDG_CACHE_HOME/tyndall or else $HOME/.cache/tyndall (empty
// when neither is an absolute path), anything else a directory of that name.
[[nodiscard]] std::string cache_directory(std::string_view place);

// Of the bytes, for finding damage; not against intent.
[[nodiscard]] std::uint64_t checksum(std::span<const std::byte> bytes);

}  // namespace tyndall::files
