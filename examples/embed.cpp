// Embeds Tyndall in a minimal engine in plain Vulkan: a device, three images and one frame.
// The engine clears its colour to black and its depth to the sky, so the picture shows only the sky. The program prints
// the radiance of a pixel above the horizon, and writes the pixels to a file if its argument names one. For brevity, an
// error ends it with a number that names the failed step. embed.c is the same program in C.
#include <tyndall/effect.hpp>

#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace {

constexpr VkExtent2D kExtent = {64, 36};

void need(bool condition, int status) {
  if (!condition) std::exit(status);
}

// Prints an error of the library, which says in one line where it happened, what is wrong and what is expected.
[[noreturn]] void fail(const tyndall::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  std::exit(1);
}

template <typename T>
T value_or_exit(tyndall::Result<T> result) {
  if (!result.ok()) fail(result.error());
  return std::move(result).value();
}

// 1. A device with the requirements of Tyndall and nothing else.
struct Device {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandBuffer cmd = VK_NULL_HANDLE;
};

Device create_device() {
  Device out;
  const tyndall::Requirements requirements = tyndall::requirements();
  VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = requirements.api_version;
  VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  instance_info.pApplicationInfo = &application;
  need(vkCreateInstance(&instance_info, nullptr, &out.instance) == VK_SUCCESS, 20);
  std::uint32_t count = 1;
  vkEnumeratePhysicalDevices(out.instance, &count, &out.physical);
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
  need(vkCreateDevice(out.physical, &device_info, nullptr, &out.device) == VK_SUCCESS, 22);
  vkGetDeviceQueue(out.device, 0, 0, &out.queue);
  VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  need(vkCreateCommandPool(out.device, &pool_info, nullptr, &out.pool) == VK_SUCCESS, 23);
  VkCommandBufferAllocateInfo cmd_info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  cmd_info.commandPool = out.pool;
  cmd_info.commandBufferCount = 1;
  need(vkAllocateCommandBuffers(out.device, &cmd_info, &out.cmd) == VK_SUCCESS, 24);
  return out;
}

// 2. The engine's images, and a buffer to read the output on the host.
struct Image {
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};
struct Buffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
};

VkDeviceMemory allocate(const Device& device, const VkMemoryRequirements& requirements, VkMemoryPropertyFlags flags) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(device.physical, &memory);
  VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = requirements.size;
  const auto fits = [&](std::uint32_t type) {
    return (requirements.memoryTypeBits >> type & 1U) != 0 && (memory.memoryTypes[type].propertyFlags & flags) == flags;
  };
  while (info.memoryTypeIndex < memory.memoryTypeCount && !fits(info.memoryTypeIndex)) ++info.memoryTypeIndex;
  need(info.memoryTypeIndex < memory.memoryTypeCount, 10);
  VkDeviceMemory out = VK_NULL_HANDLE;
  need(vkAllocateMemory(device.device, &info, nullptr, &out) == VK_SUCCESS, 11);
  return out;
}

Image create_image(const Device& device, VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) {
  Image out;
  out.aspect = aspect;
  VkImageCreateInfo info = {VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {kExtent.width, kExtent.height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage;
  need(vkCreateImage(device.device, &info, nullptr, &out.image) == VK_SUCCESS, 12);
  VkMemoryRequirements requirements;
  vkGetImageMemoryRequirements(device.device, out.image, &requirements);
  out.memory = allocate(device, requirements, 0);
  need(vkBindImageMemory(device.device, out.image, out.memory, 0) == VK_SUCCESS, 13);
  VkImageViewCreateInfo view = {VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = out.image;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {aspect, 0, 1, 0, 1};
  need(vkCreateImageView(device.device, &view, nullptr, &out.view) == VK_SUCCESS, 14);
  return out;
}

Buffer create_buffer(const Device& device, VkDeviceSize bytes) {
  Buffer out;
  VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  need(vkCreateBuffer(device.device, &info, nullptr, &out.buffer) == VK_SUCCESS, 25);
  VkMemoryRequirements requirements;
  vkGetBufferMemoryRequirements(device.device, out.buffer, &requirements);
  out.memory =
      allocate(device, requirements, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  need(vkBindBufferMemory(device.device, out.buffer, out.memory, 0) == VK_SUCCESS, 26);
  return out;
}

struct Images {
  Image color, depth, output;
  Buffer readback;
};

Images create_images(const Device& device) {
  const VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const VkImageUsageFlags write = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  Images out;
  out.color = create_image(device, VK_FORMAT_R16G16B16A16_SFLOAT, read, VK_IMAGE_ASPECT_COLOR_BIT);
  out.depth = create_image(device, VK_FORMAT_D32_SFLOAT, read, VK_IMAGE_ASPECT_DEPTH_BIT);
  out.output = create_image(device, VK_FORMAT_R32G32B32A32_SFLOAT, write, VK_IMAGE_ASPECT_COLOR_BIT);
  out.readback = create_buffer(device, VkDeviceSize{16} * kExtent.width * kExtent.height);
  return out;
}

// 3. The effect. It borrows the device.
tyndall::Effect create_effect(const Device& device) {
  tyndall::DeviceInfo info;
  info.instance = device.instance;
  info.physical_device = device.physical;
  info.device = device.device;
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
  return value_or_exit(tyndall::Effect::create(info, desc, params));
}

void wait_and_move(VkCommandBuffer cmd, const Image& image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier barrier = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.image = image.image;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.subresourceRange = {image.aspect, 0, 1, 0, 1};
  vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0,
                       nullptr, 1, &barrier);
}

// 4. A frame: draw the scene (here: clear the images), make the images readable, and record the effect.
void record_frame(VkCommandBuffer cmd, const Images& images, tyndall::Effect& effect) {
  const VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL;
  const VkClearColorValue black = {};
  const VkClearDepthStencilValue sky = {0.0F, 0};
  const VkImageSubresourceRange color_range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  const VkImageSubresourceRange depth_range = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
  value_or_exit(effect.record_precompute(cmd));
  for (const Image& image : {images.color, images.depth, images.output})
    wait_and_move(cmd, image, VK_IMAGE_LAYOUT_UNDEFINED, general);
  vkCmdClearColorImage(cmd, images.color.image, general, &black, 1, &color_range);
  vkCmdClearDepthStencilImage(cmd, images.depth.image, general, &sky, 1, &depth_range);
  wait_and_move(cmd, images.color, general, general);
  wait_and_move(cmd, images.depth, general, general);

  tyndall::FrameInputs inputs;
  inputs.extent = kExtent;
  inputs.color = {images.color.view, general};
  inputs.depth = {images.depth.view, general};
  inputs.output = {images.output.view, general};
  inputs.camera.world_from_view.m[13] = 1000.0F;  // at an altitude of 1 km, looking north (-z)
  inputs.camera.clip_from_view = {{1.0F, 0, 0, 0, 0, -16.0F / 9.0F, 0, 0, 0, 0, 0, -1, 0, 0, 0.1F, 0}};
  inputs.sun.direction_to_sun = {0.0F, 0.6F, -0.8F};
  inputs.sun.irradiance = tyndall::Vec3(1.0F);
  if (const tyndall::Result<void> recorded = effect.record(cmd, inputs); !recorded.ok()) fail(recorded.error());

  wait_and_move(cmd, images.output, general, general);
  VkBufferImageCopy copy = {};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {kExtent.width, kExtent.height, 1};
  vkCmdCopyImageToBuffer(cmd, images.output.image, general, images.readback.buffer, 1, &copy);
}

void submit_and_wait(const Device& device) {
  VkSubmitInfo submit = {VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &device.cmd;
  need(vkQueueSubmit(device.queue, 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS, 31);
  vkDeviceWaitIdle(device.device);
}

// Returns the pixels of the output, four floats each, row by row from the top.
const float* map_pixels(const Device& device, const Images& images) {
  void* data = nullptr;
  need(vkMapMemory(device.device, images.readback.memory, 0, VK_WHOLE_SIZE, 0, &data) == VK_SUCCESS, 32);
  return static_cast<const float*>(data);
}

void write_picture(const float* pixels, const char* path) {
  const std::size_t count = std::size_t{4} * kExtent.width * kExtent.height;
  std::FILE* file = std::fopen(path, "wb");
  need(file != nullptr && std::fwrite(pixels, sizeof(float), count, file) == count && std::fclose(file) == 0, 33);
}

// Prints the radiance of a pixel above the horizon. The test that runs this example checks that the sky is blue and its
// radiance plausible.
bool sky_is_blue(const float* pixels) {
  const float* pixel = pixels + 4 * (kExtent.width * (kExtent.height / 4) + kExtent.width / 2);
  std::printf("radiance of the sky: %g %g %g\n", static_cast<double>(pixel[0]), static_cast<double>(pixel[1]),
              static_cast<double>(pixel[2]));
  return pixel[2] > pixel[0] && pixel[0] > 1e-3F && pixel[2] < 1.0F;
}

void destroy(const Device& device, const Images& images) {
  for (const Image& image : {images.color, images.depth, images.output}) {
    vkDestroyImageView(device.device, image.view, nullptr);
    vkDestroyImage(device.device, image.image, nullptr);
    vkFreeMemory(device.device, image.memory, nullptr);
  }
  vkDestroyBuffer(device.device, images.readback.buffer, nullptr);
  vkFreeMemory(device.device, images.readback.memory, nullptr);
  vkDestroyCommandPool(device.device, device.pool, nullptr);
  vkDestroyDevice(device.device, nullptr);
  vkDestroyInstance(device.instance, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  const Device device = create_device();
  const Images images = create_images(device);
  {
    tyndall::Effect effect = create_effect(device);
    VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    vkBeginCommandBuffer(device.cmd, &begin);
    record_frame(device.cmd, images, effect);
    vkEndCommandBuffer(device.cmd);
    submit_and_wait(device);
  }  // destroys the effect before the device
  const float* pixels = map_pixels(device, images);
  if (argc > 1) write_picture(pixels, argv[1]);
  const bool blue = sky_is_blue(pixels);
  destroy(device, images);
  return blue ? 0 : 40;
}
