// Embeds Tyndall in a minimal engine in plain Vulkan: a device, three images and one frame.
// The engine clears its colour to black and its depth to the sky, so the picture shows only the sky. The program prints
// the radiance of a pixel above the horizon. For brevity, an error ends it with a number that names the failed step.
#include <tyndall/effect.hpp>

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {

constexpr VkExtent2D kExtent = {64, 36};

void need(bool condition, int status) {
  if (!condition) std::exit(status);
}

struct Image {
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
};

std::uint32_t memory_type(VkPhysicalDevice physical, std::uint32_t bits, VkMemoryPropertyFlags flags) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
    if ((bits >> i & 1U) != 0 && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
  }
  std::exit(10);
}

Image make_image(VkPhysicalDevice physical, VkDevice device, VkFormat format, VkImageUsageFlags usage,
                 VkImageAspectFlags aspect) {
  Image out;
  VkImageCreateInfo info = {VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {kExtent.width, kExtent.height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage;
  need(vkCreateImage(device, &info, nullptr, &out.image) == VK_SUCCESS, 11);
  VkMemoryRequirements requirements;
  vkGetImageMemoryRequirements(device, out.image, &requirements);
  VkMemoryAllocateInfo allocate = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = requirements.size;
  allocate.memoryTypeIndex = memory_type(physical, requirements.memoryTypeBits, 0);
  need(vkAllocateMemory(device, &allocate, nullptr, &out.memory) == VK_SUCCESS, 12);
  need(vkBindImageMemory(device, out.image, out.memory, 0) == VK_SUCCESS, 13);
  VkImageViewCreateInfo view = {VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = out.image;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {aspect, 0, 1, 0, 1};
  need(vkCreateImageView(device, &view, nullptr, &out.view) == VK_SUCCESS, 14);
  return out;
}

void move(VkCommandBuffer cmd, const Image& image, VkImageAspectFlags aspect, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier barrier = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.image = image.image;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.subresourceRange = {aspect, 0, 1, 0, 1};
  vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0,
                       nullptr, 1, &barrier);
}

}  // namespace

int main() {
  // 1. Create a device with the requirements of Tyndall and nothing else.
  const tyndall::Requirements requirements = tyndall::requirements();
  VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = requirements.api_version;
  VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  instance_info.pApplicationInfo = &application;
  VkInstance instance;
  need(vkCreateInstance(&instance_info, nullptr, &instance) == VK_SUCCESS, 20);
  std::uint32_t count = 1;
  VkPhysicalDevice physical;
  vkEnumeratePhysicalDevices(instance, &count, &physical);
  need(count == 1, 21);
  const float priority = 1.0F;
  VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue_info.queueCount = 1;
  queue_info.pQueuePriorities = &priority;
  VkDeviceCreateInfo device_info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  device_info.queueCreateInfoCount = 1;
  device_info.pQueueCreateInfos = &queue_info;
  device_info.enabledExtensionCount = static_cast<std::uint32_t>(requirements.device_extensions.size());
  device_info.ppEnabledExtensionNames = requirements.device_extensions.data();
  VkDevice device;
  need(vkCreateDevice(physical, &device_info, nullptr, &device) == VK_SUCCESS, 22);
  VkQueue queue;
  vkGetDeviceQueue(device, 0, 0, &queue);
  VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  VkCommandPool pool;
  need(vkCreateCommandPool(device, &pool_info, nullptr, &pool) == VK_SUCCESS, 23);
  VkCommandBufferAllocateInfo cmd_info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  cmd_info.commandPool = pool;
  cmd_info.commandBufferCount = 1;
  VkCommandBuffer cmd;
  need(vkAllocateCommandBuffers(device, &cmd_info, &cmd) == VK_SUCCESS, 24);

  // 2. Create the engine's images: linear colour, depth and output.
  const VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const Image color = make_image(physical, device, VK_FORMAT_R16G16B16A16_SFLOAT, read, VK_IMAGE_ASPECT_COLOR_BIT);
  const Image depth = make_image(physical, device, VK_FORMAT_D32_SFLOAT, read, VK_IMAGE_ASPECT_DEPTH_BIT);
  const Image output =
      make_image(physical, device, VK_FORMAT_R32G32B32A32_SFLOAT,
                 VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
  VkBufferCreateInfo buffer_info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  buffer_info.size = VkDeviceSize{16} * kExtent.width * kExtent.height;
  buffer_info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VkBuffer buffer;
  need(vkCreateBuffer(device, &buffer_info, nullptr, &buffer) == VK_SUCCESS, 25);
  VkMemoryRequirements buffer_needs;
  vkGetBufferMemoryRequirements(device, buffer, &buffer_needs);
  VkMemoryAllocateInfo allocate = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = buffer_needs.size;
  allocate.memoryTypeIndex = memory_type(physical, buffer_needs.memoryTypeBits,
                                         VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  VkDeviceMemory buffer_memory;
  need(vkAllocateMemory(device, &allocate, nullptr, &buffer_memory) == VK_SUCCESS, 26);
  vkBindBufferMemory(device, buffer, buffer_memory, 0);

  // 3. Create the effect. It borrows the device.
  tyndall::DeviceInfo info;
  info.instance = instance;
  info.physical_device = physical;
  info.device = device;
  info.get_instance_proc_addr = vkGetInstanceProcAddr;
  // Receives reports about suspicious inputs. The inputs of this program are valid, so a report is an error.
  info.message = [](void*, tyndall::Severity, std::string_view text) {
    std::fprintf(stderr, "tyndall: %.*s\n", static_cast<int>(text.size()), text.data());
    std::exit(2);
  };
  tyndall::EffectDesc desc;
  desc.max_extent = kExtent;
  desc.output_format = tyndall::OutputFormat::rgba32f;
  desc.sky_depth = 0.0F;  // reversed Z: the far plane is at 0
  tyndall::Params params;
  params.scattering.light_shafts = false;  // because this engine has no shadow maps
  {
    tyndall::Result<tyndall::Effect> effect = tyndall::Effect::create(info, desc, params);
    if (!effect.ok()) {
      std::fprintf(stderr, "%s\n", effect.error().message.c_str());
      return 1;
    }

    // 4. Record a frame: draw the scene (here: clear the images), make the images readable, and record the effect.
    VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    vkBeginCommandBuffer(cmd, &begin);
    need(effect.value().record_precompute(cmd).ok(), 30);
    const VkClearColorValue black = {};
    const VkClearDepthStencilValue sky = {0.0F, 0};
    const VkImageSubresourceRange color_range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    const VkImageSubresourceRange depth_range = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
    const VkImageLayout undefined = VK_IMAGE_LAYOUT_UNDEFINED;
    const VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL;
    move(cmd, color, VK_IMAGE_ASPECT_COLOR_BIT, undefined, general);
    move(cmd, depth, VK_IMAGE_ASPECT_DEPTH_BIT, undefined, general);
    move(cmd, output, VK_IMAGE_ASPECT_COLOR_BIT, undefined, general);
    vkCmdClearColorImage(cmd, color.image, general, &black, 1, &color_range);
    vkCmdClearDepthStencilImage(cmd, depth.image, general, &sky, 1, &depth_range);
    move(cmd, color, VK_IMAGE_ASPECT_COLOR_BIT, general, general);
    move(cmd, depth, VK_IMAGE_ASPECT_DEPTH_BIT, general, general);

    tyndall::FrameInputs inputs;
    inputs.extent = kExtent;
    inputs.color = {color.view, general};
    inputs.depth = {depth.view, general};
    inputs.output = {output.view, general};
    inputs.camera.world_from_view.m[13] = 1000.0F;  // at an altitude of 1 km, looking north (-z)
    inputs.camera.clip_from_view = {{1.0F, 0, 0, 0, 0, -16.0F / 9.0F, 0, 0, 0, 0, 0, -1, 0, 0, 0.1F, 0}};
    inputs.sun.direction_to_sun = {0.0F, 0.6F, -0.8F};
    inputs.sun.irradiance = tyndall::Vec3(1.0F);
    const tyndall::Result<void> recorded = effect.value().record(cmd, inputs);
    if (!recorded.ok()) {
      std::fprintf(stderr, "%s\n", recorded.error().message.c_str());
      return 1;
    }
    move(cmd, output, VK_IMAGE_ASPECT_COLOR_BIT, general, general);
    VkBufferImageCopy copy = {};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {kExtent.width, kExtent.height, 1};
    vkCmdCopyImageToBuffer(cmd, output.image, general, buffer, 1, &copy);
    vkEndCommandBuffer(cmd);
    VkSubmitInfo submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &cmd;
    need(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS, 31);
    vkDeviceWaitIdle(device);
  }  // destroys the effect before the device

  float* pixels = nullptr;
  vkMapMemory(device, buffer_memory, 0, VK_WHOLE_SIZE, 0, reinterpret_cast<void**>(&pixels));
  const float* middle = pixels + 4 * (kExtent.width * (kExtent.height / 4) + kExtent.width / 2);
  std::printf("radiance of the sky: %g %g %g\n", static_cast<double>(middle[0]), static_cast<double>(middle[1]),
              static_cast<double>(middle[2]));
  // The test that runs this example checks that the sky is blue and its radiance plausible.
  const bool sky_is_blue = middle[2] > middle[0] && middle[0] > 1e-3F && middle[2] < 1.0F;

  for (const Image& image : {color, depth, output}) {
    vkDestroyImageView(device, image.view, nullptr);
    vkDestroyImage(device, image.image, nullptr);
    vkFreeMemory(device, image.memory, nullptr);
  }
  vkDestroyBuffer(device, buffer, nullptr);
  vkFreeMemory(device, buffer_memory, nullptr);
  vkDestroyCommandPool(device, pool, nullptr);
  vkDestroyDevice(device, nullptr);
  vkDestroyInstance(instance, nullptr);
  return sky_is_blue ? 0 : 40;
}
