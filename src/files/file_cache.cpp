// The layout of a file is: header, version text, key, contents. Numbers have the byte order of the machine that wrote
// them; on a machine with the other order, kMark does not match.
#include "files/file_cache.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

// The functions are compiled here, so that the library is not needed at run time.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "files/files.hpp"
#include "files/text.hpp"

namespace tyndall::files {
namespace {

constexpr std::uint64_t kMark = 0x3265686361635954U;  // "TYcache2" where the lowest byte comes first
constexpr std::string_view kEnding = ".cache";

struct Header {
  std::uint64_t mark = kMark;
  std::uint64_t version_bytes = 0;
  std::uint64_t key_bytes = 0;
  std::uint64_t contents_bytes = 0;
  std::uint64_t contents_checksum = 0;
  std::uint64_t text_checksum = 0;  // of version and key
};

std::span<const std::byte> as_bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

// Computes a checksum of bytes that arrive in pieces.
class Checksum {
 public:
  Checksum() { XXH3_64bits_reset(&state_); }
  void add(std::span<const std::byte> bytes) {
    if (!bytes.empty()) XXH3_64bits_update(&state_, bytes.data(), bytes.size());
  }
  [[nodiscard]] std::uint64_t finish() const { return XXH3_64bits_digest(&state_); }

 private:
  XXH3_state_t state_;
};

// A file that is open for reading.
class OpenFile {
 public:
  // Does not wait for the other end of a pipe that has the file's name.
  explicit OpenFile(const std::string& path) : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  // Returns whether there was no such file; another process may have removed it.
  [[nodiscard]] bool missing() const { return missing_; }
  // Returns the size of a regular file; nothing for any other kind.
  [[nodiscard]] std::optional<std::uint64_t> size() const {
    struct stat info {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
    return static_cast<std::uint64_t>(info.st_size);
  }
  // Reads exactly `size` bytes; returns false when there are fewer.
  [[nodiscard]] bool read(void* to, std::size_t size) const {
    for (auto* at = static_cast<std::byte*>(to); size > 0;) {
      const ssize_t got = ::read(descriptor_, at, size);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      at += got;
      size -= static_cast<std::size_t>(got);
    }
    return true;
  }

 private:
  int descriptor_;
  bool missing_ = descriptor_ < 0 && errno == ENOENT;
};

constexpr std::size_t kPiece = std::size_t{1} << 18U;  // bytes, well within a cache

// Returns whether a file may be part of the cache; the directory is the user's and may contain others.
bool is_entry_name(std::string_view name) {
  return name.size() == 16 + kEnding.size() && name.ends_with(kEnding) &&
         name.substr(0, 16).find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

std::uint64_t checksum(std::span<const std::byte> bytes) {
  Checksum sum;
  sum.add(bytes);
  return sum.finish();
}

std::string cache_directory(std::string_view place) {
  if (place == "off") return "";
  if (place != "auto") return std::string(place);
  const auto absolute = [](const char* name) {
    const char* const value = std::getenv(name);
    return value != nullptr && value[0] == '/' ? std::string(value) : std::string();
  };
  if (const std::string cache = absolute("XDG_CACHE_HOME"); !cache.empty()) return cache + "/tyndall";
  if (const std::string home = absolute("HOME"); !home.empty()) return home + "/.cache/tyndall";
  return "";
}

BuildLock::BuildLock(BuildLock&& other) noexcept
    : state_(std::exchange(other.state_, State::unavailable)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      path_(std::move(other.path_)) {}

BuildLock::~BuildLock() {
  if (descriptor_ < 0) return;
  ::unlink(path_.c_str());  // while it is locked: try_lock() recognises a file that has lost its name
  ::close(descriptor_);
}

BuildLock FileCache::try_lock(std::string_view key) const {
  BuildLock lock;
  if (!enabled()) return lock;
  std::error_code failed;
  std::filesystem::create_directories(directory_, failed);
  // remove_leftovers() removes this file if a killed process has left it.
  lock.path_ = concat({directory_, "/.tyndall-", hexadecimal(checksum(as_bytes(key))), ".lock"});
  constexpr mode_t kMode = 0666;  // less the umask
  const int descriptor = ::open(lock.path_.c_str(), O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, kMode);
  if (descriptor < 0) return lock;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) {
      lock.state_ = BuildLock::State::busy;
    } else {
      ::unlink(lock.path_.c_str());  // this file system has no locks
    }
    ::close(descriptor);
    return lock;
  }
  struct stat opened {};
  struct stat named {};
  if (::fstat(descriptor, &opened) != 0 || ::lstat(lock.path_.c_str(), &named) != 0 || opened.st_dev != named.st_dev ||
      opened.st_ino != named.st_ino) {
    // The last holder has removed the file between opening and locking it here.
    ::close(descriptor);
    lock.state_ = BuildLock::State::busy;
    return lock;
  }
  lock.state_ = BuildLock::State::held;
  lock.descriptor_ = descriptor;
  return lock;
}

FileCache::FileCache(std::string directory, std::uint64_t limit_bytes, std::string version)
    : directory_(std::move(directory)), limit_bytes_(limit_bytes), version_(std::move(version)) {}

std::string FileCache::path(std::string_view key) const {
  return concat({directory_, "/", hexadecimal(checksum(as_bytes(key))), kEnding});
}

bool FileCache::holds(std::string_view key) const {
  std::error_code failed;
  return enabled() && std::filesystem::exists(path(key), failed);
}

std::uint64_t FileCache::size(std::string_view key) const {
  if (!holds(key)) return 0;
  const std::uint64_t bytes = OpenFile(path(key)).size().value_or(0);
  const std::uint64_t rest = sizeof(Header) + version_.size() + key.size();
  return bytes > rest ? bytes - rest : 0;
}

std::optional<std::string> FileCache::read(std::string_view key, std::uint64_t size) {
  note_.clear();
  if (!holds(key)) return std::nullopt;  // without the memory; another process may store it at any moment
  std::string out(size, '\0');
  if (!read(key, std::as_writable_bytes(std::span(out)))) return std::nullopt;
  return out;
}

bool FileCache::read(std::string_view key, std::span<std::byte> to) {
  note_.clear();
  if (!holds(key)) return false;
  const std::string file = path(key);
  const auto unusable = [&](std::string_view why) {
    note_ = concat({"the cached file ", one_line(file, 200), " is ", why, " and is rebuilt"});
    return false;
  };
  const OpenFile open(file);
  if (open.missing()) return false;
  const std::optional<std::uint64_t> bytes = open.size();
  Header header;
  if (!bytes || *bytes > sizeof header + version_.size() + key.size() + to.size() + 4096)
    return unusable("not readable or too large");
  if (*bytes < sizeof header || !open.read(&header, sizeof header)) return unusable("truncated");
  if (header.mark != kMark) return unusable("of another kind");
  const std::uint64_t rest = *bytes - sizeof header;
  if (header.version_bytes > rest || header.key_bytes > rest || header.contents_bytes > rest)
    return unusable("truncated");
  const std::uint64_t text_bytes = header.version_bytes + header.key_bytes;
  if (text_bytes + header.contents_bytes > rest) return unusable("truncated");
  if (text_bytes + header.contents_bytes < rest) return unusable("damaged");
  std::string text(text_bytes, '\0');
  if (!open.read(text.data(), text.size())) return unusable("truncated");
  if (checksum(as_bytes(text)) != header.text_checksum) return unusable("damaged");
  if (std::string_view(text).substr(0, header.version_bytes) != version_) return unusable("of another version");
  if (std::string_view(text).substr(header.version_bytes) != key || header.contents_bytes != to.size())
    return unusable("of another key");
  // Read in pieces, so that the checksum reads each piece while it is still in the processor's cache.
  Checksum sum;
  std::vector<std::byte> piece(std::min(kPiece, to.size()));
  for (std::size_t at = 0; at < to.size(); at += piece.size()) {
    const std::span<std::byte> next = std::span(piece).first(std::min(piece.size(), to.size() - at));
    if (!open.read(next.data(), next.size())) return unusable("truncated");
    sum.add(next);
    std::memcpy(to.data() + at, next.data(), next.size());
  }
  if (sum.finish() != header.contents_checksum) return unusable("damaged");
  // Marks the file as used, so that it is removed last.
  static_cast<void>(::utimensat(AT_FDCWD, file.c_str(), nullptr, 0));
  return true;
}

void FileCache::write(std::string_view key, std::span<const std::byte> contents) {
  note_.clear();
  if (!enabled()) return;
  const Header header = {kMark,           version_.size(),    key.size(),
                         contents.size(), checksum(contents), checksum(as_bytes(version_ + std::string(key)))};
  const std::uint64_t bytes = sizeof header + version_.size() + key.size() + contents.size();
  if (bytes > limit_bytes_) {
    note_ = concat({"nothing is cached in ", one_line(directory_, 200), ": ", std::to_string(bytes),
                    " bytes exceed its limit of ", std::to_string(limit_bytes_)});
    return;
  }
  std::error_code failed;
  std::filesystem::create_directories(directory_,
                                      failed);  // if it fails, AtomicFile reports that the directory is missing
  const std::string file = path(key);
  const auto store = [&]() -> Result<void> {
    Result<AtomicFile> out = AtomicFile::create(file);
    if (!out) return std::move(out).error();
    if (Result<void> r = out.value().write(&header, sizeof header); !r) return r;
    if (Result<void> r = out.value().write(version_); !r) return r;
    if (Result<void> r = out.value().write(key); !r) return r;
    if (Result<void> r = out.value().write(contents.data(), contents.size()); !r) return r;
    return out.value().commit();
  };
  if (const Result<void> stored = store(); !stored) {
    note_ = concat({"nothing is cached: ", stored.error().message});
    return;
  }
  remove_leftovers(directory_);
  make_room(file);
}

void FileCache::make_room(const std::string& new_file) const {
  struct Entry {
    std::filesystem::path path;
    std::filesystem::file_time_type used;
    std::uint64_t bytes;
  };
  std::vector<Entry> entries;
  std::uint64_t total = 0;
  std::error_code failed;
  // Other processes may add and remove files meanwhile: files that cannot be examined are skipped.
  for (std::filesystem::directory_iterator it(directory_, failed), end; !failed && it != end; it.increment(failed)) {
    std::error_code gone;
    if (!is_entry_name(it->path().filename().string()) || !it->is_regular_file(gone) || gone) continue;
    const std::uint64_t bytes = it->file_size(gone);
    const std::filesystem::file_time_type used = it->last_write_time(gone);
    if (gone) continue;
    total += bytes;
    if (it->path() != new_file) entries.push_back({it->path(), used, bytes});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& entry : entries) {
    if (total <= limit_bytes_) return;
    std::error_code remains;
    std::filesystem::remove(entry.path, remains);
    if (!remains) total -= entry.bytes;
  }
}

}  // namespace tyndall::files
