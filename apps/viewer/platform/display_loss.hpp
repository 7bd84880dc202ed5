// Handles the events for which Xlib would end the program: a lost connection to the X server, and requests for a window
// that another program has destroyed. Other platforms report such losses through the surface.
#pragma once

#include <functional>

struct GLFWwindow;

namespace tyndall::viewer {

// Sets what is called when the connection is lost; the program then exits with status 1. Call it after glfwInit().
void on_display_loss(std::function<void()> handler);
// Watches for the destruction of this window.
void watch_window(GLFWwindow* window);
// Returns whether the watched window has been destroyed.
[[nodiscard]] bool window_is_gone();

}  // namespace tyndall::viewer
