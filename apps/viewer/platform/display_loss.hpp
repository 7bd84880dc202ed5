// What X11 ends programs for by itself: a connection that breaks off, and requests for a window that somebody else has
// destroyed. Elsewhere there is nothing to do, and the surface tells.
#pragma once

#include <functional>

struct GLFWwindow;

namespace tyndall::viewer {

// `last_words` are spoken when the connection is gone; the program ends with status 1 after them. After glfwInit().
void on_display_loss(std::function<void()> last_words);
// Listens for the end of this window.
void watch_window(GLFWwindow* window);
// Whether the window that is watched is gone.
[[nodiscard]] bool window_is_gone();

}  // namespace tyndall::viewer
