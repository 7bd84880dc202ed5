// The window, through GLFW: the input events since the last frame, and the Vulkan surface.
#pragma once

#include <vulkan/vulkan.h>

#include <string>
#include <vector>

#include "gpu/host.hpp"
#include "tyndall/result.hpp"
#include "viewer/platform/key_feed.hpp"

struct GLFWwindow;

namespace tyndall::viewer {

enum class Button { left, right };

// An input event.
struct Event {
  enum class Kind { key, press, release, move, wheel };
  Kind kind = Kind::key;
  int key = 0;  // GLFW_KEY_..., pressed
  Button button = Button::left;
  double x = 0.0, y = 0.0;  // pointer [px]; for a wheel, y is the number of notches
};

class Window {
 public:
  Window() = default;
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  // Initialises and terminates GLFW. The error of a missing display says what to do instead.
  static Result<void> start();
  static void stop();
  // Adds what presenting to a window needs to the description of a device.
  static void require_presentation(gpu::HostDesc& desc);

  Result<void> open(std::uint32_t width, std::uint32_t height, const char* title);
  Result<VkSurfaceKHR> create_surface(VkInstance instance);

  // Connects ImGui's context with the window. begin_gui() passes the input to it; call it before each of its frames.
  void start_gui();
  void begin_gui();

  // Waits for events for at most `seconds` (negative: without limit; 0: not at all).
  void wait(double seconds);
  // Wakes wait(), from any thread.
  static void wake();
  // Returns the events since the last call.
  [[nodiscard]] std::vector<Event> take_events();
  // Returns whether something has happened since the last call: an event, a change of size, an exposed window.
  [[nodiscard]] bool take_activity();
  // Returns whether a key is down, or was pressed since the last forget_keys().
  [[nodiscard]] bool held(int key) const;
  void forget_keys() { touched_.clear(); }

  [[nodiscard]] bool closing() const;
  void close();
  [[nodiscard]] VkExtent2D size() const;  // size of the framebuffer [px]; 0 when minimised
  [[nodiscard]] bool minimised() const;
  [[nodiscard]] bool full_screen() const { return full_screen_; }
  void set_full_screen(bool on);
  [[nodiscard]] GLFWwindow* handle() const { return window_; }

 private:
  void install_callbacks();
  void install_key_callbacks();

  GLFWwindow* window_ = nullptr;
  std::vector<Event> events_;
  KeyFeed keys_;                      // keys and clicks that the GUI has not seen yet
  bool buttons_[2] = {false, false};  // left and right, as the GUI has seen them
  std::vector<int> touched_;          // keys pressed since the last forget_keys()
  bool activity_ = true;
  bool full_screen_ = false;
  int windowed_[4] = {0, 0, 640, 360};  // place and size before full screen
};

}  // namespace tyndall::viewer
