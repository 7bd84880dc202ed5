#include "viewer/platform/display_loss.hpp"

#include <dlfcn.h>

#if __has_include(<X11/Xlib.h>)
#include <X11/Xlib.h>
#define TYNDALL_HAS_X11
#endif

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace tyndall::viewer {
namespace {

std::function<void()>& last_words() {
  static std::function<void()> words;
  return words;
}

// Only the GUI's thread, the only one that uses Xlib, reads and writes these variables.
bool gone = false;

#ifdef TYNDALL_HAS_X11
Window watched = 0;

int end_of_connection(Display*) {
  // The handler is called only once, because an error while it saves would lead back here.
  if (const std::function<void()> words = std::exchange(last_words(), nullptr)) words();
  std::fflush(nullptr);
  std::_Exit(1);
}

int refused_request(Display*, XErrorEvent* error) {
  const bool no_window = error->error_code == BadWindow || error->error_code == BadDrawable;
  if (no_window && error->resourceid == watched) {
    gone = true;
    return 0;
  }
  std::fprintf(stderr, "tyndall: warning: the X server refused request %d with error %d\n", error->request_code,
               error->error_code);
  return 0;
}
#endif

}  // namespace

void on_display_loss(std::function<void()> words) { last_words() = std::move(words); }

void watch_window(GLFWwindow* window) {
  gone = false;
#ifdef TYNDALL_HAS_X11
  // GLFW loads Xlib and provides this function only when it runs on X11.
  void* const xlib = ::dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
  const auto window_of = reinterpret_cast<Window (*)(GLFWwindow*)>(::dlsym(RTLD_DEFAULT, "glfwGetX11Window"));
  if (xlib == nullptr || window_of == nullptr) return;
  watched = window_of(window);
  if (watched == 0) return;
  const auto set_io = reinterpret_cast<decltype(&XSetIOErrorHandler)>(::dlsym(xlib, "XSetIOErrorHandler"));
  const auto set = reinterpret_cast<decltype(&XSetErrorHandler)>(::dlsym(xlib, "XSetErrorHandler"));
  if (set_io != nullptr) set_io(&end_of_connection);
  if (set != nullptr) set(&refused_request);
#else
  (void)window;
#endif
}

bool window_is_gone() { return gone; }

}  // namespace tyndall::viewer
