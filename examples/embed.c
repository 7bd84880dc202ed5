// Embeds Tyndall in a minimal engine in plain Vulkan, through its C interface. It does the same as embed.cpp, step by
// step: a device, three images, one frame, and the radiance of a pixel above the horizon. A test compares the pictures
// of both, byte for byte.
#include <tyndall/tyndall.h>

#include <stdio.h>
#include <stdlib.h>

enum { kWidth = 64, kHeight = 36 };

static void need(int condition, int status) {
  if (!condition) exit(status);
}

// Ends the program with the text of an error of the library, which says in one line where it happened, what is wrong
// and what is expected.
static void check(TyndallStatus status) {
  if (status == TyndallStatus_success) return;
  fprintf(stderr, "%s: %s\n", tyndall_status_name(status), tyndall_last_error());
  exit(1);
}

// 1. A device with the requirements of Tyndall and nothing else.
typedef struct Device {
  VkInstance instance;
  VkPhysicalDevice physical;
  VkDevice device;
  VkQueue queue;
  VkCommandPool pool;
  VkCommandBuffer cmd;
} Device;

static Device create_device(void) {
  Device out = {0};
  TyndallRequirements requirements = {.struct_size = sizeof requirements};
  check(tyndall_requirements(&requirements));
  VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = requirements.api_version};
  VkInstanceCreateInfo instance_info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                        .pApplicationInfo = &application};
  need(vkCreateInstance(&instance_info, NULL, &out.instance) == VK_SUCCESS, 20);
  uint32_t count = 1;
  vkEnumeratePhysicalDevices(out.instance, &count, &out.physical);
  need(count == 1, 21);
  const float priority = 1.0F;
  VkDeviceQueueCreateInfo queue_info = {
      .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
  VkDeviceCreateInfo device_info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                    .queueCreateInfoCount = 1,
                                    .pQueueCreateInfos = &queue_info,
                                    .enabledExtensionCount = requirements.device_extension_count,
                                    .ppEnabledExtensionNames = requirements.device_extensions};
  need(vkCreateDevice(out.physical, &device_info, NULL, &out.device) == VK_SUCCESS, 22);
  vkGetDeviceQueue(out.device, 0, 0, &out.queue);
  VkCommandPoolCreateInfo pool_info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  need(vkCreateCommandPool(out.device, &pool_info, NULL, &out.pool) == VK_SUCCESS, 23);
  VkCommandBufferAllocateInfo cmd_info = {
      .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, .commandPool = out.pool, .commandBufferCount = 1};
  need(vkAllocateCommandBuffers(out.device, &cmd_info, &out.cmd) == VK_SUCCESS, 24);
  return out;
}

// 2. The engine's images, and a buffer to read the output on the host.
typedef struct Image {
  VkImage image;
  VkDeviceMemory memory;
  VkImageView view;
  VkImageAspectFlags aspect;
} Image;

typedef struct Images {
  Image color, depth, output;
  VkBuffer readback;
  VkDeviceMemory readback_memory;
} Images;

static VkDeviceMemory allocate(const Device* device, const VkMemoryRequirements* requirements,
                               VkMemoryPropertyFlags flags) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(device->physical, &memory);
  VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = requirements->size};
  while (info.memoryTypeIndex < memory.memoryTypeCount &&
         ((requirements->memoryTypeBits >> info.memoryTypeIndex & 1U) == 0 ||
          (memory.memoryTypes[info.memoryTypeIndex].propertyFlags & flags) != flags)) {
    ++info.memoryTypeIndex;
  }
  need(info.memoryTypeIndex < memory.memoryTypeCount, 10);
  VkDeviceMemory out = VK_NULL_HANDLE;
  need(vkAllocateMemory(device->device, &info, NULL, &out) == VK_SUCCESS, 11);
  return out;
}

static Image create_image(const Device* device, VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspect) {
  Image out = {.aspect = aspect};
  VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                            .imageType = VK_IMAGE_TYPE_2D,
                            .format = format,
                            .extent = {kWidth, kHeight, 1},
                            .mipLevels = 1,
                            .arrayLayers = 1,
                            .samples = VK_SAMPLE_COUNT_1_BIT,
                            .usage = usage};
  need(vkCreateImage(device->device, &info, NULL, &out.image) == VK_SUCCESS, 12);
  VkMemoryRequirements requirements;
  vkGetImageMemoryRequirements(device->device, out.image, &requirements);
  out.memory = allocate(device, &requirements, 0);
  need(vkBindImageMemory(device->device, out.image, out.memory, 0) == VK_SUCCESS, 13);
  VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                .image = out.image,
                                .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                .format = format,
                                .subresourceRange = {aspect, 0, 1, 0, 1}};
  need(vkCreateImageView(device->device, &view, NULL, &out.view) == VK_SUCCESS, 14);
  return out;
}

static void create_readback(const Device* device, Images* images) {
  VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                             .size = 16 * kWidth * kHeight,
                             .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
  need(vkCreateBuffer(device->device, &info, NULL, &images->readback) == VK_SUCCESS, 25);
  VkMemoryRequirements requirements;
  vkGetBufferMemoryRequirements(device->device, images->readback, &requirements);
  images->readback_memory =
      allocate(device, &requirements, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  need(vkBindBufferMemory(device->device, images->readback, images->readback_memory, 0) == VK_SUCCESS, 26);
}

static Images create_images(const Device* device) {
  const VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const VkImageUsageFlags write = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  Images out;
  out.color = create_image(device, VK_FORMAT_R16G16B16A16_SFLOAT, read, VK_IMAGE_ASPECT_COLOR_BIT);
  out.depth = create_image(device, VK_FORMAT_D32_SFLOAT, read, VK_IMAGE_ASPECT_DEPTH_BIT);
  out.output = create_image(device, VK_FORMAT_R32G32B32A32_SFLOAT, write, VK_IMAGE_ASPECT_COLOR_BIT);
  create_readback(device, &out);
  return out;
}

// 3. The effect. It borrows the device.

// Receives reports about suspicious inputs. The inputs of this program are valid, so a report is an error.
static void message(void* user, TyndallSeverity severity, const char* text) {
  (void)user;
  (void)severity;
  fprintf(stderr, "tyndall: %s\n", text);
  exit(2);
}

static TyndallEffect* create_effect(const Device* device) {
  TyndallDeviceInfo info;
  check(tyndall_device_info_defaults(&info, sizeof info));
  info.instance = device->instance;
  info.physical_device = device->physical;
  info.device = device->device;
  info.get_instance_proc_addr = vkGetInstanceProcAddr;
  info.message = message;
  TyndallEffectDesc desc;
  check(tyndall_effect_desc_defaults(&desc, sizeof desc));
  desc.max_extent = (VkExtent2D){kWidth, kHeight};
  desc.output_format = TyndallOutputFormat_rgba32f;
  desc.sky_depth = 0.0F;  // reversed Z: the far plane is at 0
  TyndallParams* params = NULL;
  check(tyndall_params_create(&params));
  check(tyndall_params_set_number(params, "scattering.light_shafts", 0));  // because this engine has no shadow maps
  TyndallEffect* effect = NULL;
  check(tyndall_effect_create(&info, &desc, params, &effect));
  tyndall_params_destroy(params);
  return effect;
}

static void wait_and_move(VkCommandBuffer cmd, const Image* image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                  .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                  .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                                  .oldLayout = from,
                                  .newLayout = to,
                                  .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                  .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                  .image = image->image,
                                  .subresourceRange = {image->aspect, 0, 1, 0, 1}};
  vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0, NULL,
                       1, &barrier);
}

// 4. A frame: draw the scene (here: clear the images), make the images readable, and record the effect.
static void draw_scene(VkCommandBuffer cmd, const Images* images) {
  const VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL;
  const VkClearColorValue black = {{0}};
  const VkClearDepthStencilValue sky = {0.0F, 0};
  const VkImageSubresourceRange color_range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  const VkImageSubresourceRange depth_range = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
  wait_and_move(cmd, &images->color, VK_IMAGE_LAYOUT_UNDEFINED, general);
  wait_and_move(cmd, &images->depth, VK_IMAGE_LAYOUT_UNDEFINED, general);
  wait_and_move(cmd, &images->output, VK_IMAGE_LAYOUT_UNDEFINED, general);
  vkCmdClearColorImage(cmd, images->color.image, general, &black, 1, &color_range);
  vkCmdClearDepthStencilImage(cmd, images->depth.image, general, &sky, 1, &depth_range);
  wait_and_move(cmd, &images->color, general, general);
  wait_and_move(cmd, &images->depth, general, general);
}

static void record_frame(VkCommandBuffer cmd, const Images* images, TyndallEffect* effect) {
  const VkImageLayout general = VK_IMAGE_LAYOUT_GENERAL;
  check(tyndall_effect_record_precompute(effect, cmd, UINT32_MAX, NULL));
  draw_scene(cmd, images);

  TyndallFrameInputs inputs;
  check(tyndall_frame_inputs_defaults(&inputs, sizeof inputs));
  inputs.extent = (VkExtent2D){kWidth, kHeight};
  inputs.color = (TyndallTexture){.view = images->color.view, .layout = general};
  inputs.depth = (TyndallTexture){.view = images->depth.view, .layout = general};
  inputs.output = (TyndallTexture){.view = images->output.view, .layout = general};
  // The camera is at an altitude of 1 km and looks north (-z).
  inputs.camera = (TyndallCamera){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1000, 0, 1},
                                  {1, 0, 0, 0, 0, -16.0F / 9.0F, 0, 0, 0, 0, 0, -1, 0, 0, 0.1F, 0}};
  inputs.sun = (TyndallSun){.direction_to_sun = {0.0F, 0.6F, -0.8F},
                            .irradiance = {1.0F, 1.0F, 1.0F},
                            .angular_radius_rad = inputs.sun.angular_radius_rad};
  check(tyndall_effect_record(effect, cmd, &inputs));

  wait_and_move(cmd, &images->output, general, general);
  VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                            .imageExtent = {kWidth, kHeight, 1}};
  vkCmdCopyImageToBuffer(cmd, images->output.image, general, images->readback, 1, &copy);
}

static void submit_and_wait(const Device* device) {
  VkSubmitInfo submit = {
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &device->cmd};
  need(vkQueueSubmit(device->queue, 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS, 31);
  vkDeviceWaitIdle(device->device);
}

// Writes the pixels of the output, four floats each, row by row from the top.
static void write_picture(const float* pixels, const char* path) {
  const size_t count = 4 * kWidth * kHeight;
  FILE* file = fopen(path, "wb");
  need(file != NULL && fwrite(pixels, sizeof(float), count, file) == count && fclose(file) == 0, 33);
}

static int sky_is_blue(const float* pixels) {
  const float* pixel = pixels + 4 * (kWidth * (kHeight / 4) + kWidth / 2);
  printf("radiance of the sky: %g %g %g\n", (double)pixel[0], (double)pixel[1], (double)pixel[2]);
  return pixel[2] > pixel[0] && pixel[0] > 1e-3F && pixel[2] < 1.0F;
}

static void destroy_image(const Device* device, const Image* image) {
  vkDestroyImageView(device->device, image->view, NULL);
  vkDestroyImage(device->device, image->image, NULL);
  vkFreeMemory(device->device, image->memory, NULL);
}

static void destroy(const Device* device, const Images* images) {
  destroy_image(device, &images->color);
  destroy_image(device, &images->depth);
  destroy_image(device, &images->output);
  vkDestroyBuffer(device->device, images->readback, NULL);
  vkFreeMemory(device->device, images->readback_memory, NULL);
  vkDestroyCommandPool(device->device, device->pool, NULL);
  vkDestroyDevice(device->device, NULL);
  vkDestroyInstance(device->instance, NULL);
}

int main(int argc, char** argv) {
  const Device device = create_device();
  const Images images = create_images(&device);
  TyndallEffect* effect = create_effect(&device);
  VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  vkBeginCommandBuffer(device.cmd, &begin);
  record_frame(device.cmd, &images, effect);
  vkEndCommandBuffer(device.cmd);
  submit_and_wait(&device);
  tyndall_effect_destroy(effect);  // before the device
  void* data = NULL;
  need(vkMapMemory(device.device, images.readback_memory, 0, VK_WHOLE_SIZE, 0, &data) == VK_SUCCESS, 32);
  if (argc > 1) write_picture(data, argv[1]);
  const int blue = sky_is_blue(data);
  destroy(&device, &images);
  return blue ? 0 : 40;
}
