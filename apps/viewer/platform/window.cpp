#include "viewer/platform/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <algorithm>

#include "viewer/platform/display_loss.hpp"

namespace tyndall::viewer {
namespace {

std::string glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason given";
}

Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

}  // namespace

Window::~Window() {
  if (window_ != nullptr) glfwDestroyWindow(window_);
}

Result<void> Window::start() {
  if (glfwInit() != GLFW_TRUE) {
    return Error{ErrorCode::unsupported_device,
                 "tyndall view: there is no display for a window (" + glfw_error() +
                     "); expected an X11 or Wayland display, or 'xvfb-run tyndall view'; 'tyndall render' needs none"};
  }
  if (glfwVulkanSupported() != GLFW_TRUE) {
    glfwTerminate();
    return Error{ErrorCode::unsupported_device,
                 "tyndall view: Vulkan cannot draw into windows; expected a Vulkan loader and a driver with "
                 "VK_KHR_surface; 'tyndall render' needs no window"};
  }
  return {};
}

void Window::stop() { glfwTerminate(); }

void Window::require_presentation(gpu::HostDesc& desc) {
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (names != nullptr) desc.instance_extensions.assign(names, names + count);
  desc.device_extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  desc.can_present = [](VkInstance instance, VkPhysicalDevice device, std::uint32_t queue_family) {
    return glfwGetPhysicalDevicePresentationSupport(instance, device, queue_family) == GLFW_TRUE;
  };
}

Result<void> Window::open(std::uint32_t width, std::uint32_t height, const char* title) {
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window_ = glfwCreateWindow(static_cast<int>(width), static_cast<int>(height), title, nullptr, nullptr);
  if (window_ == nullptr) {
    return Error{ErrorCode::unsupported_device,
                 "tyndall view: the window cannot be opened (" + glfw_error() +
                     "); expected a display; 'tyndall render' makes pictures without one"};
  }
  glfwSetWindowSizeLimits(window_, 64, 64, GLFW_DONT_CARE, GLFW_DONT_CARE);
  install_callbacks();
  return {};
}

void Window::install_callbacks() {
  glfwSetWindowUserPointer(window_, this);
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
    Window& self = of(w);
    self.activity_ = true;
    if (button != GLFW_MOUSE_BUTTON_LEFT && button != GLFW_MOUSE_BUTTON_RIGHT) return;
    Event event;
    event.kind = action == GLFW_PRESS ? Event::Kind::press : Event::Kind::release;
    event.button = button == GLFW_MOUSE_BUTTON_LEFT ? Button::left : Button::right;
    glfwGetCursorPos(w, &event.x, &event.y);
    self.events_.push_back(event);
    self.keys_.add({KeyEvent::Kind::button, button, 0, action, 0, 0, event.x, event.y});
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    Window& self = of(w);
    self.activity_ = true;
    self.events_.push_back({Event::Kind::move, 0, Button::left, x, y});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
    Window& self = of(w);
    self.activity_ = true;
    self.events_.push_back({Event::Kind::wheel, 0, Button::left, 0.0, y});
  });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { of(w).activity_ = true; });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { of(w).activity_ = true; });
  glfwSetWindowIconifyCallback(window_, [](GLFWwindow* w, int) { of(w).activity_ = true; });
  glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int) { of(w).activity_ = true; });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int) { of(w).activity_ = true; });
}

void Window::install_key_callbacks() {
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
    Window& self = of(w);
    self.activity_ = true;
    if (action != GLFW_REPEAT) self.keys_.add({KeyEvent::Kind::key, key, scancode, action, mods, 0});
    if (action != GLFW_PRESS) return;
    self.touched_.push_back(key);
    self.events_.push_back({Event::Kind::key, key, Button::left, 0.0, 0.0});
  });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned character) {
    of(w).activity_ = true;
    of(w).keys_.add({KeyEvent::Kind::character, 0, 0, 0, 0, character});
  });
}

Result<VkSurfaceKHR> Window::create_surface(VkInstance instance) {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  const VkResult result = glfwCreateWindowSurface(instance, window_, nullptr, &surface);
  if (result == VK_SUCCESS) return surface;
  return Error{ErrorCode::unsupported_device,
               "tyndall view: the window has no Vulkan surface (" + glfw_error() +
                   "); expected a driver that can present to this display",
               static_cast<std::int32_t>(result)};
}

void Window::wait(double seconds) {
  if (seconds < 0.0) {
    glfwWaitEvents();
  } else if (seconds > 0.0) {
    glfwWaitEventsTimeout(seconds);
  } else {
    glfwPollEvents();
  }
}

void Window::wake() { glfwPostEmptyEvent(); }

std::vector<Event> Window::take_events() { return std::exchange(events_, {}); }

bool Window::take_activity() { return std::exchange(activity_, false) || !keys_.empty(); }

void Window::start_gui() {
  ImGui_ImplGlfw_InitForVulkan(window_, true);
  // ImGui has installed callbacks that call ours; keys are passed to it through KeyFeed instead.
  install_key_callbacks();
}

void Window::begin_gui() {
  const std::vector<KeyEvent> events = keys_.take();
  for (const KeyEvent& event : events) {
    if (event.kind == KeyEvent::Kind::key)
      ImGui_ImplGlfw_KeyCallback(window_, event.key, event.scancode, event.action, event.mods);
    if (event.kind == KeyEvent::Kind::character) ImGui_ImplGlfw_CharCallback(window_, event.character);
  }
  ImGui_ImplGlfw_NewFrame();
  // NewFrame() has read the current position of the mouse pointer. A click is reported at the position where it
  // happened.
  ImGuiIO& io = ImGui::GetIO();
  // GLFW returns an arbitrary size for a window that another program has destroyed.
  if (window_is_gone()) io.DisplaySize = ImVec2(0.0F, 0.0F);
  for (const KeyEvent& event : events) {
    if (event.kind != KeyEvent::Kind::button) continue;
    buttons_[event.key] = event.action == GLFW_PRESS;
    io.MousePos = ImVec2(static_cast<float>(event.x), static_cast<float>(event.y));
  }
  for (int i : {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_RIGHT}) io.MouseDown[i] = buttons_[i];
}

bool Window::held(int key) const {
  return glfwGetKey(window_, key) == GLFW_PRESS || std::find(touched_.begin(), touched_.end(), key) != touched_.end();
}

bool Window::closing() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

VkExtent2D Window::size() const {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  if (window_is_gone()) return {0, 0};
  return {static_cast<std::uint32_t>(std::max(width, 0)), static_cast<std::uint32_t>(std::max(height, 0))};
}

bool Window::minimised() const {
  return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE || size().width == 0 || size().height == 0;
}

void Window::set_full_screen(bool on) {
  if (on == full_screen_) return;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (on && monitor == nullptr) return;
  if (on) {
    glfwGetWindowPos(window_, &windowed_[0], &windowed_[1]);
    glfwGetWindowSize(window_, &windowed_[2], &windowed_[3]);
    const GLFWvidmode* mode = glfwGetVideoMode(monitor);
    if (mode == nullptr) return;
    glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
  } else {
    glfwSetWindowMonitor(window_, nullptr, windowed_[0], windowed_[1], windowed_[2], windowed_[3], GLFW_DONT_CARE);
  }
  full_screen_ = on;
  activity_ = true;
}

}  // namespace tyndall::viewer
