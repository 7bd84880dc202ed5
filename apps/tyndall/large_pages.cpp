#include "large_pages.hpp"

#include <sys/auxv.h>
#include <unistd.h>

#include <climits>
#include <cstdlib>
#include <fstream>
#include <string>

namespace tyndall::cli {
namespace {

// Returns whether the kernel gives large pages to a process that requests them, and to no other.
bool granted_on_request() {
  std::ifstream file("/sys/kernel/mm/transparent_hugepage/enabled");
  std::string text;
  std::getline(file, text);
  return text.find("[madvise]") != std::string::npos;
}

}  // namespace

void restart_with_large_pages(char** argv) {
#ifdef __GLIBC__
  constexpr const char* kTunables = "GLIBC_TUNABLES";
  // Without a base address of the dynamic linker, the linker itself was started with this program as its argument.
  if (std::getenv(kTunables) != nullptr || ::getauxval(AT_BASE) == 0 || !granted_on_request()) return;
  // The path, not the link, because the process gets its name from it.
  char path[PATH_MAX];
  const ssize_t size = ::readlink("/proc/self/exe", path, sizeof path - 1);
  if (size <= 0) return;
  path[size] = '\0';
  ::setenv(kTunables, "glibc.malloc.hugetlb=1", 1);
  ::execv(path, argv);
  ::unsetenv(kTunables);
#else
  static_cast<void>(argv);
#endif
}

}  // namespace tyndall::cli
