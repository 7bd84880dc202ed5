// The swapchain of the window. Up to gpu::kFramesInFlight frames are in flight. The GUI is drawn last in each of them.
#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <functional>
#include <vector>

#include "gpu/frames_in_flight.hpp"
#include "gpu/host.hpp"
#include "viewer/platform/window.hpp"

namespace tyndall::viewer {

// The result of drawing a frame.
enum class Drawn {
  done,
  not_now,       // the window has no area, or its surface has just changed: try again
  surface_lost,  // recover() makes a new surface
};

class Swapchain {
 public:
  Swapchain() = default;
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;
  ~Swapchain();

  // Creates the swapchain. Call it after ImGui::CreateContext() and ImGui_ImplGlfw_InitForVulkan().
  Result<void> create(gpu::Host& host, Window& window, bool vsync);
  Result<void> recover();
  void set_vsync(bool on);
  [[nodiscard]] bool vsync() const { return vsync_; }

  // Calls `picture` to record into a rendering scope over the whole window, draws ImGui's draw data on top, and
  // presents. Waits for the frame gpu::kFramesInFlight calls ago, not for this one.
  Result<Drawn> draw(const std::function<Result<void>(VkCommandBuffer, VkExtent2D)>& picture);

  [[nodiscard]] VkFormat format() const { return format_.format; }
  [[nodiscard]] VkExtent2D extent() const { return extent_; }
  [[nodiscard]] const char* present_mode() const;

 private:
  struct Target {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    VkSemaphore rendered = VK_NULL_HANDLE;
  };

  Result<void> create_surface();
  Result<void> create_render_pass();
  Result<void> create_frame_objects();
  Result<void> start_gui();
  // The objects that a frame of the window uses while it executes.
  struct Frame {
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    VkSemaphore acquired = VK_NULL_HANDLE;
    bool pending = false;  // the frame has been submitted and not waited for
  };
  Result<void> wait_for(Frame& frame);
  Result<bool> create_swapchain();  // false: the window has no area now
  void destroy_targets();
  Result<void> record(VkCommandBuffer cmd, const Target& target,
                      const std::function<Result<void>(VkCommandBuffer, VkExtent2D)>& picture);

  gpu::Host* host_ = nullptr;
  Window* window_ = nullptr;
  bool vsync_ = true;
  bool stale_ = true;  // the swapchain has to be recreated
  bool gui_ = false;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkSurfaceFormatKHR format_ = {};
  VkPresentModeKHR mode_ = VK_PRESENT_MODE_FIFO_KHR;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_ = {};
  std::vector<Target> targets_;
  VkRenderPass render_pass_ = VK_NULL_HANDLE;
  VkDescriptorPool descriptors_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  std::array<Frame, gpu::kFramesInFlight> frames_;
  std::uint32_t frame_ = 0;  // index of the next frame
};

}  // namespace tyndall::viewer
