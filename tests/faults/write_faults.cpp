// Makes writes to files fail, one call at a time. Preloaded into a process (LD_PRELOAD) or linked into a test, it
// replaces the functions of the C library that create, write and rename files. Only files below the folder
// TYNDALL_FAULT_FOLDER count. Environment:
//   TYNDALL_FAULT_FOLDER  absolute path of the folder
//   TYNDALL_FAULT_AT      number of the call that fails, from 1; 0: none
//   TYNDALL_FAULT_ERROR   the value of errno that the call sets, or a value of write_faults.hpp
//   TYNDALL_FAULT_CALL    fails only calls with this name, and counts only these
//   TYNDALL_FAULT_LOG     a file outside the folder that receives the name of each counted call, one a line
// Tests in the same process call tyndall_write_faults() instead.
#include "write_faults.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

struct Settings {
  std::string folder, call, log;
  long at = 0;
  int error = 0;  // of errno, or of write_faults.hpp
};

// A pointer, because calls arrive before and after the lifetime of static objects.
Settings* settings = nullptr;
std::atomic<long> calls{0};
std::atomic<bool> has_unnamed_files{true};
constexpr int kMaxDescriptors = 4096;
std::array<std::atomic<bool>, kMaxDescriptors> tracked;

const char* environment(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

const Settings& current() {
  static const bool once = [] {
    if (settings != nullptr) return true;
    auto* const made = new Settings;
    made->folder = environment("TYNDALL_FAULT_FOLDER");
    made->call = environment("TYNDALL_FAULT_CALL");
    made->log = environment("TYNDALL_FAULT_LOG");
    made->at = std::atol(environment("TYNDALL_FAULT_AT"));
    made->error = std::atoi(environment("TYNDALL_FAULT_ERROR"));
    settings = made;
    return true;
  }();
  static_cast<void>(once);
  return *settings;
}

template <typename Function>
Function* original(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

bool is_inside(const char* path) {
  const std::string& folder = current().folder;
  if (path == nullptr || folder.empty() || std::strncmp(path, folder.c_str(), folder.size()) != 0) return false;
  return path[folder.size()] == '\0' || path[folder.size()] == '/';
}

bool is_tracked(int descriptor) {
  return descriptor >= 0 && descriptor < kMaxDescriptors && tracked[std::size_t(descriptor)];
}

void log_call(const char* name) {
  if (current().log.empty()) return;
  static const auto open_file = original<int(const char*, int, ...)>("open");
  static const auto write_file = original<ssize_t(int, const void*, size_t)>("write");
  const int file = open_file(current().log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0) return;
  const std::string line = std::string(name) + "\n";
  static_cast<void>(write_file(file, line.data(), line.size()));
  ::close(file);
}

enum class Effect { normal, fails, is_short, is_killed };

// Counts a call and returns what is to happen to it; sets errno if it fails.
Effect effect_of(const char* name) {
  const Settings& now = current();
  if (!now.call.empty() && now.call != name) return Effect::normal;
  log_call(name);
  if (++calls != now.at) return Effect::normal;
  if (now.error == kShortWrite) return Effect::is_short;
  if (now.error == kKillInside && std::strcmp(name, "write") == 0) return Effect::is_killed;
  if (now.error < 0) std::raise(SIGKILL);
  errno = now.error;
  return Effect::fails;
}

bool fails(const char* name) { return effect_of(name) == Effect::fails; }

int open_with(const char* symbol, const char* path, int flags, mode_t mode) {
  const bool writes = (flags & O_ACCMODE) != O_RDONLY && is_inside(path);
  if (writes && !has_unnamed_files && (flags & O_TMPFILE) == O_TMPFILE) {
    errno = EOPNOTSUPP;
    return -1;
  }
  if (writes && fails("open")) return -1;
  const int descriptor = original<int(const char*, int, ...)>(symbol)(path, flags, mode);
  if (descriptor >= 0 && descriptor < kMaxDescriptors) tracked[std::size_t(descriptor)] = writes;
  return descriptor;
}

mode_t mode_of(int flags, std::va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

extern "C" {

void tyndall_write_faults(const char* folder, long at, int error, const char* call) {
  delete settings;
  settings = new Settings{folder, call, "", at, error};
  calls = 0;
}

void tyndall_unnamed_files(bool available) { has_unnamed_files = available; }

long tyndall_write_calls() { return calls; }

int open(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_with("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_with("open64", path, flags, mode);
}

ssize_t write(int descriptor, const void* data, size_t size) {
  static const auto next = original<ssize_t(int, const void*, size_t)>("write");
  if (is_tracked(descriptor)) {
    const Effect now = effect_of("write");
    if (now == Effect::fails) return -1;
    if (now != Effect::normal && size > 1) size /= 2;
    if (now == Effect::is_killed) {
      static_cast<void>(next(descriptor, data, size));
      std::raise(SIGKILL);
    }
  }
  return next(descriptor, data, size);
}

off_t lseek(int descriptor, off_t offset, int whence) noexcept {
  static const auto next = original<off_t(int, off_t, int)>("lseek");
  return is_tracked(descriptor) && fails("lseek") ? -1 : next(descriptor, offset, whence);
}

int fchmod(int descriptor, mode_t mode) noexcept {
  static const auto next = original<int(int, mode_t)>("fchmod");
  return is_tracked(descriptor) && fails("fchmod") ? -1 : next(descriptor, mode);
}

int close(int descriptor) {
  static const auto next = original<int(int)>("close");
  const bool ours = is_tracked(descriptor);
  if (ours) tracked[std::size_t(descriptor)] = false;
  const bool failed = ours && fails("close");  // as network file systems do, which write late
  const int reason = errno;
  const int result = next(descriptor);
  if (!failed) return result;
  errno = reason;
  return -1;
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
  static const auto next = original<int(int, const char*, int, const char*, int)>("linkat");
  return is_inside(to) && fails("linkat") ? -1 : next(from_folder, from, to_folder, to, flags);
}

int rename(const char* from, const char* to) noexcept {
  static const auto next = original<int(const char*, const char*)>("rename");
  return is_inside(to) && fails("rename") ? -1 : next(from, to);
}

int mkdir(const char* path, mode_t mode) noexcept {
  static const auto next = original<int(const char*, mode_t)>("mkdir");
  return is_inside(path) && fails("mkdir") ? -1 : next(path, mode);
}

int flock(int descriptor, int operation) noexcept {
  static const auto next = original<int(int, int)>("flock");
  return is_tracked(descriptor) && fails("flock") ? -1 : next(descriptor, operation);
}

}  // extern "C"
