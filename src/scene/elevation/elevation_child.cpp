#include "scene/elevation/elevation_child.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string_view>

#include "scene/elevation/elevation_gdal.hpp"

namespace tyndall::scene {
namespace {

constexpr rlim_t kMaxSeconds = 300;                  // of processor time
constexpr rlim_t kMaxMoreBytes = rlim_t{16} << 30U;  // of address space, beyond that of the parent
constexpr int kOutOfMemory = 3, kNotWritten = 4;     // exit statuses

void limit(int resource, rlim_t value) {
  rlimit now = {};
  if (::getrlimit(resource, &now) != 0 || (now.rlim_cur != RLIM_INFINITY && now.rlim_cur <= value)) return;
  now.rlim_cur = value;
  ::setrlimit(resource, &now);
}

rlim_t address_space() {
  unsigned long long pages = 0;
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0;
  if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
  std::fclose(file);
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

// Makes the child end with its parent, resets the signal handlers that it inherits, and sets its limits.
void prepare() {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU})
    std::signal(number, SIG_DFL);
  // A reader that crashes may print a message, which would look like one of this program.
  if (const int nothing = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nothing >= 0) {
    ::dup2(nothing, STDOUT_FILENO);
    ::dup2(nothing, STDERR_FILENO);
  }
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, kMaxSeconds);
  if (const rlim_t used = address_space(); used > 0) limit(RLIMIT_AS, used + kMaxMoreBytes);
}

bool write_all(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(to, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

[[noreturn]] void run_child(int to, const std::function<std::string()>& work) {
  int status = kNotWritten;
  try {
    prepare();
    if (write_all(to, work())) status = 0;
  } catch (const std::bad_alloc&) {
    status = kOutOfMemory;
  } catch (const std::exception&) {
    status = kNotWritten;
  }
  ::_exit(status);
}

std::string read_all(int from) {
  std::string out;
  std::array<char, 1 << 16> piece;
  for (;;) {
    const ssize_t got = ::read(from, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return out;
    out.append(piece.data(), static_cast<std::size_t>(got));
  }
}

// Returns why the child has not written its result.
Error failure(const std::string& source, int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory)
    return Error{ErrorCode::out_of_memory, "elevation file " + source + " does not fit into memory", 0};
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return elevation_error(source, "cannot be read within " + std::to_string(kMaxSeconds) + " s of processor time");
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGINT || WTERMSIG(status) == SIGTERM))
    return elevation_error(source, "was not read: interrupted");
  return elevation_error(source, "has an unsupported format or is damaged (its reader crashed)");
}

}  // namespace

Result<std::string> in_child(const std::string& source, const std::function<std::string()>& work) {
  std::array<int, 2> pipe = {-1, -1};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
    return elevation_error(source, "cannot be read: no pipe to a child process");
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(pipe[0]);
    run_child(pipe[1], work);
  }
  ::close(pipe[1]);
  if (child < 0) {
    ::close(pipe[0]);
    return elevation_error(source, "cannot be read: no child process can be started");
  }
  std::string bytes;
  bool stored = true;
  try {
    bytes = read_all(pipe[0]);
  } catch (const std::bad_alloc&) {
    stored = false;
  }
  ::close(pipe[0]);  // a child that still writes ends
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!stored) return Error{ErrorCode::out_of_memory, "elevation file " + source + " does not fit into memory", 0};
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return failure(source, status);
  return bytes;
}

}  // namespace tyndall::scene
