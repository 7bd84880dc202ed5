#include "viewer/platform/swapchain.hpp"

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>

#include "gpu/try.hpp"

namespace tyndall::viewer {
namespace {

Result<void> checked(VkResult result, const char* what, const char* name) {
  if (result == VK_SUCCESS) return {};
  return gpu::vulkan_error(result, what, name);
}

// Prefers 8 bits without sRGB conversion: the shaders encode their output, and the GUI's colours are encoded already.
VkSurfaceFormatKHR choose_format(const std::vector<VkSurfaceFormatKHR>& formats) {
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
    for (const VkSurfaceFormatKHR& format : formats) {
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
    }
  }
  return formats.empty() ? VkSurfaceFormatKHR{VK_FORMAT_B8G8R8A8_UNORM, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR} : formats[0];
}

VkImageMemoryBarrier to_attachment(VkImage image) {
  VkImageMemoryBarrier barrier = {};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
  barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  barrier.newLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  return barrier;
}

}  // namespace

Swapchain::~Swapchain() {
  if (host_ == nullptr) return;
  const VkDevice device = host_->device().device;
  host_->wait_idle();
  if (gui_) ImGui_ImplVulkan_Shutdown();
  destroy_targets();
  if (swapchain_ != VK_NULL_HANDLE) vkDestroySwapchainKHR(device, swapchain_, nullptr);
  for (const Frame& frame : frames_) {
    if (frame.acquired != VK_NULL_HANDLE) vkDestroySemaphore(device, frame.acquired, nullptr);
    if (frame.fence != VK_NULL_HANDLE) vkDestroyFence(device, frame.fence, nullptr);
  }
  if (pool_ != VK_NULL_HANDLE) vkDestroyCommandPool(device, pool_, nullptr);
  if (descriptors_ != VK_NULL_HANDLE) vkDestroyDescriptorPool(device, descriptors_, nullptr);
  if (render_pass_ != VK_NULL_HANDLE) vkDestroyRenderPass(device, render_pass_, nullptr);
  if (surface_ != VK_NULL_HANDLE) vkDestroySurfaceKHR(host_->device().instance, surface_, nullptr);
}

Result<void> Swapchain::create(gpu::Host& host, Window& window, bool vsync) {
  host_ = &host;
  window_ = &window;
  vsync_ = vsync;
  TYNDALL_TRY(create_surface());
  TYNDALL_TRY(create_render_pass());
  TYNDALL_TRY(create_frame_objects());
  return start_gui();
}

Result<void> Swapchain::create_surface() {
  TYNDALL_ASSIGN(surface_, window_->create_surface(host_->device().instance));
  const VkPhysicalDevice physical = host_->device().physical_device;
  VkBool32 supported = VK_FALSE;
  vkGetPhysicalDeviceSurfaceSupportKHR(physical, host_->queue_family(), surface_, &supported);
  if (supported != VK_TRUE) {
    return Error{ErrorCode::unsupported_device,
                 "--device: '" + host_->device_name() +
                     "' cannot present to this window; expected another device, see 'tyndall devices'"};
  }
  std::uint32_t count = 0;
  vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface_, &count, nullptr);
  std::vector<VkSurfaceFormatKHR> formats(count);
  vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface_, &count, formats.data());
  formats.resize(count);
  if (format_.format == VK_FORMAT_UNDEFINED) format_ = choose_format(formats);
  return {};
}

Result<void> Swapchain::create_render_pass() {
  VkAttachmentDescription color = {};
  color.format = format_.format;
  color.samples = VK_SAMPLE_COUNT_1_BIT;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  color.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  color.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  color.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  color.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  const VkAttachmentReference reference = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass = {};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  const VkAccessFlags access = VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
  const VkSubpassDependency dependency = {VK_SUBPASS_EXTERNAL,
                                          0,
                                          VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                          VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                          VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                          access,
                                          0};
  VkRenderPassCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = info.subpassCount = info.dependencyCount = 1;
  info.pAttachments = &color;
  info.pSubpasses = &subpass;
  info.pDependencies = &dependency;
  return checked(vkCreateRenderPass(host_->device().device, &info, nullptr, &render_pass_), "creating",
                 "the render pass");
}

Result<void> Swapchain::create_frame_objects() {
  const VkDevice device = host_->device().device;
  VkCommandPoolCreateInfo pool = {};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool.queueFamilyIndex = host_->queue_family();
  TYNDALL_TRY(checked(vkCreateCommandPool(device, &pool, nullptr, &pool_), "creating", "the window's command pool"));
  VkCommandBufferAllocateInfo allocate = {};
  allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  allocate.commandPool = pool_;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  VkFenceCreateInfo fence = {};
  fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  VkSemaphoreCreateInfo semaphore = {};
  semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  for (Frame& frame : frames_) {
    TYNDALL_TRY(
        checked(vkAllocateCommandBuffers(device, &allocate, &frame.cmd), "allocating", "the window's command buffer"));
    TYNDALL_TRY(checked(vkCreateFence(device, &fence, nullptr, &frame.fence), "creating", "the window's fence"));
    TYNDALL_TRY(
        checked(vkCreateSemaphore(device, &semaphore, nullptr, &frame.acquired), "creating", "the window's semaphore"));
  }
  const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
  VkDescriptorPoolCreateInfo descriptors = {};
  descriptors.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  descriptors.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
  descriptors.maxSets = 8;
  descriptors.poolSizeCount = 1;
  descriptors.pPoolSizes = &size;
  return checked(vkCreateDescriptorPool(device, &descriptors, nullptr, &descriptors_), "creating",
                 "the GUI's descriptor pool");
}

Result<void> Swapchain::start_gui() {
  ImGui_ImplVulkan_InitInfo info = {};
  info.Instance = host_->device().instance;
  info.PhysicalDevice = host_->device().physical_device;
  info.Device = host_->device().device;
  info.QueueFamily = host_->queue_family();
  info.Queue = host_->queue();
  info.DescriptorPool = descriptors_;
  info.MinImageCount = 2;
  info.ImageCount = 2;
  info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
  ImGui_ImplVulkan_Init(&info, render_pass_);
  gui_ = true;
  TYNDALL_TRY(host_->run([](VkCommandBuffer cmd) -> Result<void> {
    ImGui_ImplVulkan_CreateFontsTexture(cmd);
    return {};
  }));
  ImGui_ImplVulkan_DestroyFontUploadObjects();
  return {};
}

Result<void> Swapchain::recover() {
  const VkDevice device = host_->device().device;
  host_->wait_idle();
  destroy_targets();
  if (swapchain_ != VK_NULL_HANDLE) vkDestroySwapchainKHR(device, swapchain_, nullptr);
  swapchain_ = VK_NULL_HANDLE;
  if (surface_ != VK_NULL_HANDLE) vkDestroySurfaceKHR(host_->device().instance, surface_, nullptr);
  surface_ = VK_NULL_HANDLE;
  stale_ = true;
  return create_surface();
}

void Swapchain::set_vsync(bool on) {
  stale_ = stale_ || on != vsync_;
  vsync_ = on;
}

const char* Swapchain::present_mode() const {
  switch (mode_) {
    case VK_PRESENT_MODE_IMMEDIATE_KHR: return "immediate";
    case VK_PRESENT_MODE_MAILBOX_KHR: return "mailbox";
    case VK_PRESENT_MODE_FIFO_KHR: return "fifo";
    default: return "other";
  }
}

void Swapchain::destroy_targets() {
  const VkDevice device = host_->device().device;
  for (const Target& target : targets_) {
    if (target.framebuffer != VK_NULL_HANDLE) vkDestroyFramebuffer(device, target.framebuffer, nullptr);
    if (target.view != VK_NULL_HANDLE) vkDestroyImageView(device, target.view, nullptr);
    if (target.rendered != VK_NULL_HANDLE) vkDestroySemaphore(device, target.rendered, nullptr);
  }
  targets_.clear();
}

Result<bool> Swapchain::create_swapchain() {
  const VkDevice device = host_->device().device;
  const VkPhysicalDevice physical = host_->device().physical_device;
  VkSurfaceCapabilitiesKHR caps = {};
  VkResult result = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(physical, surface_, &caps);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "querying", "the window's surface");
  const VkExtent2D window = window_->size();
  VkExtent2D extent = caps.currentExtent;
  if (extent.width == UINT32_MAX) {
    extent.width = std::clamp(window.width, caps.minImageExtent.width, caps.maxImageExtent.width);
    extent.height = std::clamp(window.height, caps.minImageExtent.height, caps.maxImageExtent.height);
  }
  if (extent.width == 0 || extent.height == 0) return false;
  std::uint32_t count = 0;
  vkGetPhysicalDeviceSurfacePresentModesKHR(physical, surface_, &count, nullptr);
  std::vector<VkPresentModeKHR> modes(count);
  vkGetPhysicalDeviceSurfacePresentModesKHR(physical, surface_, &count, modes.data());
  const auto offers = [&](VkPresentModeKHR mode) { return std::find(modes.begin(), modes.end(), mode) != modes.end(); };
  mode_ = VK_PRESENT_MODE_FIFO_KHR;
  if (!vsync_ && offers(VK_PRESENT_MODE_MAILBOX_KHR)) mode_ = VK_PRESENT_MODE_MAILBOX_KHR;
  if (!vsync_ && offers(VK_PRESENT_MODE_IMMEDIATE_KHR)) mode_ = VK_PRESENT_MODE_IMMEDIATE_KHR;

  host_->wait_idle();
  VkSwapchainCreateInfoKHR info = {};
  info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
  info.surface = surface_;
  info.minImageCount = std::max(caps.minImageCount, 2U);
  if (caps.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, caps.maxImageCount);
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
  info.preTransform = caps.currentTransform;
  info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  info.presentMode = mode_;
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain_;
  VkSwapchainKHR made = VK_NULL_HANDLE;
  result = vkCreateSwapchainKHR(device, &info, nullptr, &made);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "creating", "the swapchain");
  destroy_targets();
  if (swapchain_ != VK_NULL_HANDLE) vkDestroySwapchainKHR(device, swapchain_, nullptr);
  swapchain_ = made;
  extent_ = extent;

  vkGetSwapchainImagesKHR(device, swapchain_, &count, nullptr);
  std::vector<VkImage> images(count);
  vkGetSwapchainImagesKHR(device, swapchain_, &count, images.data());
  for (const VkImage image : images) {
    Target& target = targets_.emplace_back();
    target.image = image;
    VkImageViewCreateInfo view = {};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_.format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    TYNDALL_TRY(checked(vkCreateImageView(device, &view, nullptr, &target.view), "creating a view of", "the window"));
    VkFramebufferCreateInfo framebuffer = {};
    framebuffer.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    framebuffer.renderPass = render_pass_;
    framebuffer.attachmentCount = 1;
    framebuffer.pAttachments = &target.view;
    framebuffer.width = extent.width;
    framebuffer.height = extent.height;
    framebuffer.layers = 1;
    TYNDALL_TRY(
        checked(vkCreateFramebuffer(device, &framebuffer, nullptr, &target.framebuffer), "creating", "a framebuffer"));
    VkSemaphoreCreateInfo semaphore = {};
    semaphore.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    TYNDALL_TRY(checked(vkCreateSemaphore(device, &semaphore, nullptr, &target.rendered), "creating", "a semaphore"));
  }
  stale_ = false;
  return true;
}

Result<void> Swapchain::record(VkCommandBuffer cmd, const Target& target,
                               const std::function<Result<void>(VkCommandBuffer, VkExtent2D)>& picture) {
  const gpu::Device& device = host_->device();
  // Makes the scene's writes, which other commands made, visible.
  gpu::barrier(device, cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_ACCESS_MEMORY_WRITE_BIT,
               VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
  const VkImageMemoryBarrier barrier = to_attachment(target.image);
  vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
  VkRenderingAttachmentInfo color = {};
  color.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  color.imageView = target.view;
  color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  color.clearValue.color = {{0.06F, 0.08F, 0.11F, 1.0F}};
  VkRenderingInfo rendering = {};
  rendering.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  rendering.renderArea = {{0, 0}, extent_};
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &color;
  device.vk.CmdBeginRendering(cmd, &rendering);
  const VkViewport viewport = {0, 0, static_cast<float>(extent_.width), static_cast<float>(extent_.height), 0, 1};
  const VkRect2D scissor = {{0, 0}, extent_};
  device.vk.CmdSetViewport(cmd, 0, 1, &viewport);
  device.vk.CmdSetScissor(cmd, 0, 1, &scissor);
  Result<void> drawn = picture(cmd, extent_);
  device.vk.CmdEndRendering(cmd);
  VkRenderPassBeginInfo begin = {};
  begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  begin.renderPass = render_pass_;
  begin.framebuffer = target.framebuffer;
  begin.renderArea = {{0, 0}, extent_};
  vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
  if (ImDrawData* data = ImGui::GetDrawData(); data != nullptr) ImGui_ImplVulkan_RenderDrawData(data, cmd);
  vkCmdEndRenderPass(cmd);
  return drawn;
}

Result<void> Swapchain::wait_for(Frame& frame) {
  if (!frame.pending) return {};
  const VkDevice device = host_->device().device;
  TYNDALL_TRY(
      checked(vkWaitForFences(device, 1, &frame.fence, VK_TRUE, UINT64_MAX), "waiting for", "the window's frame"));
  frame.pending = false;
  return checked(vkResetFences(device, 1, &frame.fence), "resetting", "the window's fence");
}

Result<Drawn> Swapchain::draw(const std::function<Result<void>(VkCommandBuffer, VkExtent2D)>& picture) {
  if (window_->minimised()) return Drawn::not_now;
  const VkExtent2D window = window_->size();
  if (window.width != extent_.width || window.height != extent_.height) stale_ = true;
  if (stale_) {
    const Result<bool> made = create_swapchain();
    if (!made && made.error().vk_result == VK_ERROR_SURFACE_LOST_KHR) return Drawn::surface_lost;
    if (!made && made.error().vk_result == VK_ERROR_OUT_OF_DATE_KHR) return Drawn::not_now;
    if (!made) return made.error();
    if (!made.value()) return Drawn::not_now;
  }
  Frame& frame = frames_[frame_];
  TYNDALL_TRY(wait_for(frame));
  std::uint32_t index = 0;
  VkResult result =
      vkAcquireNextImageKHR(host_->device().device, swapchain_, UINT64_MAX, frame.acquired, VK_NULL_HANDLE, &index);
  if (result == VK_ERROR_OUT_OF_DATE_KHR) {
    stale_ = true;
    return Drawn::not_now;
  }
  if (result == VK_ERROR_SURFACE_LOST_KHR) return Drawn::surface_lost;
  if (result == VK_SUBOPTIMAL_KHR)
    stale_ = true;
  else if (result != VK_SUCCESS)
    return gpu::vulkan_error(result, "acquiring", "the window's next picture");

  const Target& target = targets_[index];
  VkCommandBufferBeginInfo begin = {};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  TYNDALL_TRY(checked(vkBeginCommandBuffer(frame.cmd, &begin), "beginning", "the window's command buffer"));
  TYNDALL_TRY(record(frame.cmd, target, picture));
  TYNDALL_TRY(checked(vkEndCommandBuffer(frame.cmd), "ending", "the window's command buffer"));
  const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  VkSubmitInfo submit = {};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.waitSemaphoreCount = submit.commandBufferCount = submit.signalSemaphoreCount = 1;
  submit.pWaitSemaphores = &frame.acquired;
  submit.pWaitDstStageMask = &stage;
  submit.pCommandBuffers = &frame.cmd;
  submit.pSignalSemaphores = &target.rendered;
  VkPresentInfoKHR present = {};
  present.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
  present.waitSemaphoreCount = present.swapchainCount = 1;
  present.pWaitSemaphores = &target.rendered;
  present.pSwapchains = &swapchain_;
  present.pImageIndices = &index;
  {
    const std::unique_lock<std::mutex> locked = host_->lock();
    TYNDALL_TRY(checked(vkQueueSubmit(host_->queue(), 1, &submit, frame.fence), "submitting", "the window's frame"));
    frame.pending = true;
    result = vkQueuePresentKHR(host_->queue(), &present);
  }
  frame_ = (frame_ + 1) % gpu::kFramesInFlight;
  if (result == VK_ERROR_SURFACE_LOST_KHR) return Drawn::surface_lost;
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
    stale_ = true;
    return result == VK_SUBOPTIMAL_KHR ? Drawn::done : Drawn::not_now;
  }
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "presenting", "the window's frame");
  return Drawn::done;
}

}  // namespace tyndall::viewer
