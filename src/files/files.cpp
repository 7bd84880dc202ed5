// POSIX files: bounded reading, and writing through a nameless or temporary file.
#include "files/files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "files/text.hpp"

namespace tyndall::files {
namespace {

constexpr std::size_t kLongestShownPath = 200;

std::string shown(std::string_view path) { return concat({"'", one_line(path, kLongestShownPath), "'"}); }

std::string reason(int code) { return std::generic_category().message(code); }

Error io_error(std::string_view what, std::string_view path, std::string_view why) {
  return Error{ErrorCode::io, concat({shown(path), ": ", what, ": ", why})};
}

Error read_error(const std::string& path, int code) {
  return io_error("cannot read", path, concat({reason(code), "; expected a readable file"}));
}

std::string directory_of(const std::string& path) {
  const std::string parent = std::filesystem::path(path).parent_path().string();
  return parent.empty() ? "." : parent;
}

// Returns a name in `directory` that no other process uses. It is short, so that it is not too long where the target's
// own name is not.
std::string temporary_name(const std::string& directory, int attempt) {
  return concat({directory, "/.tyndall-", std::to_string(::getpid()), "-", std::to_string(attempt), ".tmp"});
}

constexpr int kAttempts = 1000;
constexpr mode_t kNewFileMode = 0666;  // less the umask

constexpr std::string_view kTemporaryPrefix = ".tyndall-";

// Returns the file that writing to `path` creates or replaces. Symbolic links are followed, even those whose target
// does not exist yet. Returns an empty text for an endless chain of links.
std::string followed(const std::string& path) {
  constexpr int kMaxLinks = 40;  // as the kernel allows
  std::filesystem::path target = path;
  for (int links = 0; links <= kMaxLinks; ++links) {
    std::error_code failed;
    if (!std::filesystem::is_symlink(std::filesystem::symlink_status(target, failed))) return target.string();
    const std::filesystem::path next = std::filesystem::read_symlink(target, failed);
    if (failed) return "";
    target = target.parent_path() / next;  // `next` itself when it is absolute
  }
  return "";
}

// Copies a file from its beginning; returns false, with errno set, when it cannot be read or written.
bool copy_contents(int from, int to) {
  char piece[1 << 16];
  off_t position = 0;
  for (;;) {
    const ssize_t got = ::pread(from, piece, sizeof piece, position);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return got == 0;
    for (ssize_t done = 0; done < got;) {
      const ssize_t written = ::write(to, piece + done, static_cast<std::size_t>(got - done));
      if (written == 0) errno = ENOSPC;
      if (written == 0 || (written < 0 && errno != EINTR)) return false;
      if (written > 0) done += written;
    }
    position += got;
  }
}

}  // namespace

void remove_leftovers(const std::string& directory) {
  namespace fs = std::filesystem;
  // A writer locks its temporary file right after creating it; in between, only the file's age protects it.
  constexpr auto kMinAge = std::chrono::minutes(1);
  std::error_code failed;
  for (fs::directory_iterator it(directory, failed), end; !failed && it != end; it.increment(failed)) {
    if (!it->path().filename().string().starts_with(kTemporaryPrefix)) continue;
    std::error_code gone;
    const bool folder = fs::is_directory(it->symlink_status(gone));
    if (!folder && !fs::is_regular_file(it->symlink_status(gone))) continue;
    if (fs::file_time_type::clock::now() - fs::last_write_time(it->path(), gone) < kMinAge || gone) continue;
    const int descriptor =
        ::open(it->path().c_str(), (folder ? O_RDONLY | O_DIRECTORY : O_RDWR) | O_CLOEXEC | O_NOFOLLOW);
    if (descriptor < 0) continue;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) fs::remove_all(it->path(), gone);
    ::close(descriptor);
  }
}

Result<std::string> read_file(const std::string& path, std::uint64_t limit) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return read_error(path, errno);
  struct stat info {};
  std::string contents;
  int failure = 0;
  if (::fstat(descriptor, &info) != 0) {
    failure = errno;
  } else if (S_ISDIR(info.st_mode)) {
    failure = EISDIR;
  }
  // Pipes and devices have no known size; some never end.
  constexpr std::uint64_t kLargestStream = std::uint64_t{256} << 20U;
  if (!S_ISREG(info.st_mode)) limit = std::min(limit, kLargestStream);
  constexpr std::size_t kChunk = std::size_t{1} << 20U;
  std::size_t used = 0;
  while (failure == 0 && used <= limit) {
    // Regular files are read in one piece, with one byte more to detect the end.
    const std::uint64_t expected = static_cast<std::uint64_t>(std::max<off_t>(info.st_size, 0)) + 1;
    const std::uint64_t wanted = used < expected ? expected - used : kChunk;
    contents.resize(used + static_cast<std::size_t>(std::min<std::uint64_t>(wanted, limit + 1 - used)));
    if (contents.size() == used) break;
    const ssize_t got = ::read(descriptor, contents.data() + used, contents.size() - used);
    if (got == 0) break;
    if (got > 0) used += static_cast<std::size_t>(got);
    if (got < 0 && errno != EINTR) failure = errno;
  }
  ::close(descriptor);
  if (failure != 0) return read_error(path, failure);
  if (used > limit)
    return io_error("cannot read", path,
                    concat({"the file is too large; expected at most ", std::to_string(limit), " bytes"}));
  contents.resize(used);
  return contents;
}

Result<AtomicFile> AtomicFile::create(const std::string& path) {
  AtomicFile file;
  file.shown_ = path;
  file.path_ = path;
  if (path.empty()) return io_error("cannot write", path, "the name is empty; expected a file name");
  if (path.find('\0') != std::string::npos) {
    return io_error("cannot write", path, "the name contains a zero byte; expected a file name");
  }
  struct stat info {};
  const bool exists = ::stat(path.c_str(), &info) == 0;
  if (!exists && errno != ENOENT) return file.error("cannot write");
  if (path.back() == '/') return io_error("cannot write", path, "it names a directory; expected a file");
  if (exists && S_ISDIR(info.st_mode)) return io_error("cannot write", path, "it is a directory; expected a file");
  if (exists && !S_ISREG(info.st_mode)) {
    file.descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (file.descriptor_ < 0) return file.error("cannot write");
    return file;
  }
  if (exists && ::access(path.c_str(), W_OK) != 0) return file.error("cannot write");
  file.path_ = followed(path);
  if (file.path_.empty()) return io_error("cannot write", path, "its symbolic links form a loop; expected a file");
  const std::string directory = directory_of(file.path_);
  if (::access("/proc/self/fd", X_OK) == 0) {
    file.descriptor_ = ::open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kNewFileMode);
    file.nameless_ = file.descriptor_ >= 0;
  }
  if (!file.nameless_ && !file.open_temporary()) return file.error("cannot write");
  // Best effort: some network file systems have neither locks nor modes.
  static_cast<void>(::flock(file.descriptor_, LOCK_EX | LOCK_NB));
  if (exists) file.mode_ = info.st_mode & 07777U;
  if (exists) static_cast<void>(::fchmod(file.descriptor_, *file.mode_));
  return file;
}

bool AtomicFile::open_temporary() {
  const std::string directory = directory_of(path_);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::string name = temporary_name(directory, attempt);
    descriptor_ = ::open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, kNewFileMode);
    if (descriptor_ >= 0) temporary_ = name;
    if (descriptor_ >= 0 || errno != EEXIST) break;
  }
  return descriptor_ >= 0;
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      shown_(std::move(other.shown_)),
      path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      mode_(other.mode_),
      nameless_(other.nameless_) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this != &other) {
    discard();
    descriptor_ = std::exchange(other.descriptor_, -1);
    shown_ = std::move(other.shown_);
    path_ = std::move(other.path_);
    temporary_ = std::exchange(other.temporary_, {});
    mode_ = other.mode_;
    nameless_ = other.nameless_;
  }
  return *this;
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::discard() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

Error AtomicFile::error(std::string_view what) const {
  return io_error(what, shown_, concat({reason(errno), "; expected a writable location with free space"}));
}

Result<void> AtomicFile::write(const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written == 0) errno = ENOSPC;  // allowed by POSIX; trying again might never end
    if (written <= 0) return error("cannot write");
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  return {};
}

Result<void> AtomicFile::seek(std::uint64_t position) {
  if (::lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) return error("cannot seek in");
  return {};
}

Result<void> AtomicFile::commit() {
  if (nameless_) {
    // An unnamed file cannot replace another one: it gets a temporary name first.
    const std::string source = concat({"/proc/self/fd/", std::to_string(descriptor_)});
    const std::string directory = directory_of(path_);
    int linked = -1;
    for (int attempt = 0; linked != 0 && attempt < kAttempts; ++attempt) {
      const std::string name = temporary_name(directory, attempt);
      linked = ::linkat(AT_FDCWD, source.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW);
      if (linked == 0) temporary_ = name;
      if (linked != 0 && errno != EEXIST) break;
    }
    if (linked != 0 && !copy_to_named()) return error("cannot write");
  }
  if (::close(std::exchange(descriptor_, -1)) != 0) return error("cannot write");
  if (temporary_.empty()) return {};
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) return error("cannot write");
  temporary_.clear();
  return {};
}

bool AtomicFile::copy_to_named() {
  const int nameless = std::exchange(descriptor_, -1);
  const bool copied = open_temporary() && copy_contents(nameless, descriptor_);
  if (copied && mode_) static_cast<void>(::fchmod(descriptor_, *mode_));
  const int reason = errno;
  ::close(nameless);
  errno = reason;
  return copied;
}

Result<void> write_file(const std::string& path, std::string_view contents) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return std::move(file).error();
  if (Result<void> written = file.value().write(contents); !written) return written;
  return file.value().commit();
}

Result<void> check_writable(const std::string& path) {
  // Do not open a pipe only to check it: closing it again would end the stream for its reader.
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode)) return {};
  const Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  remove_leftovers(directory_of(followed(path)));
  return {};
}

}  // namespace tyndall::files
