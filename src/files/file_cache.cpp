// The layout of a file is: header, version text, key, contents. Numbers have the byte order of the machine that wrote
// them; on a machine with the other order, kMark does not match.
#include "files/file_cache.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <vector>

#include "files/files.hpp"
#include "files/text.hpp"

namespace tyndall::files {
namespace {

constexpr std::uint64_t kMark = 0x3165686361635954U;  // "TYcache1" where the lowest byte comes first
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

// Computes a checksum of `total` bytes that arrive in pieces; all but the last are multiples of 32 bytes long. Words
// are multiplied and rotated in four independent lanes, which is as fast as memory can be read. The mixing function of
// SplitMix64 finishes the sum.
class Checksum {
 public:
  explicit Checksum(std::uint64_t total)
      : lanes_{0x9e3779b97f4a7c15U, 0xbf58476d1ce4e5b9U, 0x94d049bb133111ebU, total} {}

  void add(std::span<const std::byte> bytes) {
    std::size_t at = 0;
    const auto word = [&](std::size_t offset) {
      std::uint64_t value = 0;
      std::memcpy(&value, bytes.data() + offset, std::min<std::size_t>(8, bytes.size() - offset));
      return value;
    };
    for (; at + 32 <= bytes.size(); at += 32) {
      for (std::size_t i = 0; i < 4; ++i) lanes_[i] = mix(lanes_[i], word(at + 8 * i));
    }
    for (std::size_t lane = 0; at < bytes.size(); at += 8, ++lane) lanes_[lane] = mix(lanes_[lane], word(at));
  }

  [[nodiscard]] std::uint64_t finish() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t lane : lanes_) {
      sum = mix(sum, lane);
      sum = (sum ^ (sum >> 30U)) * 0xbf58476d1ce4e5b9U;
      sum ^= sum >> 27U;
    }
    return sum;
  }

 private:
  static std::uint64_t mix(std::uint64_t lane, std::uint64_t value) {
    return std::rotl((lane ^ value) * 0x9fb21c651e98df25U, 29);
  }
  std::array<std::uint64_t, 4> lanes_;
};

// A file that is open for reading.
class OpenFile {
 public:
  explicit OpenFile(const std::string& path) : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
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

std::string hexadecimal(std::uint64_t value) {
  std::string out(16, '0');
  for (std::size_t i = 0; i < out.size(); ++i) out[15 - i] = "0123456789abcdef"[(value >> (4 * i)) & 15U];
  return out;
}

// Returns whether a file may be part of the cache; the directory is the user's and may contain others.
bool is_entry_name(std::string_view name) {
  return name.size() == 16 + kEnding.size() && name.ends_with(kEnding) &&
         name.substr(0, 16).find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

std::uint64_t checksum(std::span<const std::byte> bytes) {
  Checksum sum(bytes.size());
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
  std::string out(holds(key) ? size : 0, '\0');
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
  Checksum sum(to.size());
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
    std::filesystem::remove(entry.path, failed);
    total -= entry.bytes;
  }
}

}  // namespace tyndall::files
