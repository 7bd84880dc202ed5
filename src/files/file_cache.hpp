// A cache on disk for results that are expensive to compute: one file for each key, all in one directory. A file
// appears complete or not at all, so any number of processes may share the directory. Files are checked when they are
// read: one that is truncated, damaged, of another version or of another key counts as missing. A failure of the cache
// never fails a run; note() describes it in one line. Use each object from one thread only.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tyndall/result.hpp"

namespace tyndall::files {

// The right to build what belongs to a key, which one process at a time has. It ends with the object or the process.
class BuildLock {
 public:
  enum class State {
    held,
    busy,         // another process builds it; try again
    unavailable,  // the cache is disabled, or its folder permits no locks: build without one
  };

  BuildLock(BuildLock&& other) noexcept;
  BuildLock& operator=(BuildLock&&) = delete;
  BuildLock(const BuildLock&) = delete;
  BuildLock& operator=(const BuildLock&) = delete;
  ~BuildLock();

  [[nodiscard]] State state() const { return state_; }

 private:
  friend class FileCache;
  BuildLock() = default;

  State state_ = State::unavailable;
  int descriptor_ = -1;
  std::string path_;
};

class FileCache {
 public:
  // Creates a disabled cache: reads find nothing, and writes store nothing.
  FileCache() = default;
  // Creates a cache in a directory, which is created when something is first stored. The files together stay below
  // `limit_bytes`; the least recently used ones are removed first. `version` distinguishes the files of this program
  // from those that other versions stored under the same keys.
  FileCache(std::string directory, std::uint64_t limit_bytes, std::string version);

  [[nodiscard]] bool enabled() const { return !directory_.empty(); }
  [[nodiscard]] const std::string& directory() const { return directory_; }

  // Returns whether there is a file for the key; read() may still reject it.
  [[nodiscard]] bool holds(std::string_view key) const;
  // Returns the size of what was stored under the key, which read() verifies; 0 if there is no such file.
  [[nodiscard]] std::uint64_t size(std::string_view key) const;
  // Returns what was stored under the key, if it has `size` bytes, and marks it as used.
  [[nodiscard]] std::optional<std::string> read(std::string_view key, std::uint64_t size);
  // Reads into the caller's memory, which is written once, in order, and never read, so that it may be device memory.
  // If this returns false, the contents of that memory are undefined.
  [[nodiscard]] bool read(std::string_view key, std::span<std::byte> to);
  // Stores the contents under the key, replacing what was there.
  void write(std::string_view key, std::span<const std::byte> contents);

  // Takes the right to build what belongs to the key, so that several processes do not all do the same work. Does not
  // wait. The other functions do not need the lock.
  [[nodiscard]] BuildLock try_lock(std::string_view key) const;

  // Returns one line that says why the last read or write failed; empty if it succeeded or if nothing was stored.
  [[nodiscard]] const std::string& note() const { return note_; }

  // Returns the path of a key's file.
  [[nodiscard]] std::string path(std::string_view key) const;

 private:
  void make_room(const std::string& new_file) const;

  std::string directory_;
  std::uint64_t limit_bytes_ = 0;
  std::string version_;
  std::string note_;
};

// Returns the directory that tables.cache names: nothing for "off"; for "auto" $XDG_CACHE_HOME/tyndall, else
// $HOME/.cache/tyndall, or nothing when neither is an absolute path; otherwise the name itself.
[[nodiscard]] std::string cache_directory(std::string_view place);

// Returns a checksum (XXH3, 64 bits) that detects damage, but not deliberate changes.
[[nodiscard]] std::uint64_t checksum(std::span<const std::byte> bytes);

}  // namespace tyndall::files
