// Replaces `tyndall view` in the portable bundle: the viewer is a program of its own beside this one, because it loads
// the X libraries, which a machine without a display may lack.
#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "cli.hpp"
#include "files/text.hpp"
#include "verbs.hpp"

namespace tyndall::cli {

bool has_viewer() { return true; }
bool has_shader_reload() { return false; }

int run_view(Args args) {
  // GLFW is linked with this library. It loads the other X libraries only when it opens a window.
  constexpr const char* kDesktopLibrary = "libX11.so.6";
  if (void* const library = ::dlopen(kDesktopLibrary, RTLD_LAZY); library == nullptr) {
    return fail(
        files::concat({"tyndall view: cannot load '", kDesktopLibrary, "'; expected the X libraries of a desktop"}),
        kFailed);
  }
  std::error_code error;
  std::string program = std::filesystem::read_symlink("/proc/self/exe", error).string() + "-view";
  std::vector<std::string> words(args.begin(), args.end());
  std::string verb = "view";
  std::vector<char*> argv = {program.data(), verb.data()};
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  ::execv(program.c_str(), argv.data());
  return fail(files::concat({"tyndall view: cannot start '", files::one_line(program, 300), "': ", std::strerror(errno),
                             "; expected the viewer beside the program"}),
              kFailed);
}

}  // namespace tyndall::cli
