// Embeds Tyndall in an engine with other conventions and needs than embed.cpp:
//   * its world has z up (right-handed, x east, y north), its clip space y up, its depth standard Z,
//   * it draws the two eyes of a stereo pair into one image, at a resolution that changes between frames,
//   * it lights its surfaces by a sky probe, whose cube map it could also use for reflections.
// It clears its colour and depth, so that the picture shows only the sky. The program prints what coefficients and cube
// map say of a surface that faces upwards, and fails if they differ by more than 1.5 %. With the pixels that embed.cpp
// writes as its argument, it compares its left eye with them.
#include <tyndall/conventions.hpp>
#include <tyndall/effect.hpp>
#include <tyndall/sky_probe.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "vulkan_host.hpp"

namespace {

using namespace host;
using namespace tyndall::conventions;

constexpr VkExtent2D kEye = {64, 36};
constexpr VkExtent2D kAtlas = {128, 36};  // both eyes, side by side
constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;

// The engine's camera, sun and projection, in its own conventions.
tyndall::Mat4 camera_at(float x, float z) {  // looks north; its axes are east, up and south
  return {{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, x, 0, z, 1}};
}
tyndall::Mat4 projection(float near_m, float far_m) {  // y up, depth 0 at the near plane and 1 at the far plane
  const float a = far_m / (near_m - far_m);
  return {{1.0F, 0, 0, 0, 0, 16.0F / 9.0F, 0, 0, 0, 0, a, -1, 0, 0, near_m * a, 0}};
}
constexpr tyndall::Vec3 kTowardsSun = {0.0F, 0.8F, 0.6F};

tyndall::Effect create_effect(const Device& device) {
  tyndall::EffectDesc desc;
  desc.max_extent = kEye;
  desc.views = 2;  // eyes
  desc.output_format = tyndall::OutputFormat::rgba32f;
  desc.sky_depth = 1.0F;  // standard Z
  tyndall::Params params;
  params.scattering.light_shafts = false;  // because this engine has no shadow maps
  return value_or_exit(tyndall::Effect::create(device_info(device), desc, params));
}

// Converts a half float. Precondition: it is a normal positive number, at least 6e-5.
float from_half(std::uint16_t half) { return std::ldexp(static_cast<float>(half % 1024 + 1024), half / 1024 - 25); }

// Records both eyes of a frame, each in its half of the images.
void record_eyes(VkCommandBuffer cmd, const Images& images, tyndall::Effect& effect, std::uint64_t frame,
                 VkExtent2D extent) {
  for (std::uint32_t eye = 0; eye < 2; ++eye) {
    const VkOffset2D offset = {static_cast<std::int32_t>(eye * kEye.width), 0};
    tyndall::FrameInputs inputs;
    inputs.frame_index = frame;
    inputs.view = eye;
    inputs.extent = extent;
    inputs.color = {images.color.view, kGeneral, offset};
    inputs.depth = {images.depth.view, kGeneral, offset};
    inputs.output = {images.output.view, kGeneral, offset};
    inputs.camera.world_from_view = world_from_view(kZUp, camera_at(0.065F * static_cast<float>(eye), 1000.0F), kSame);
    inputs.camera.clip_from_view = y_flipped(clip_from_view(projection(0.1F, 1.0e6F), kSame));
    inputs.sun.direction_to_sun = direction(kZUp, kTowardsSun);
    inputs.sun.irradiance = tyndall::Vec3(1.0F);
    if (const tyndall::Result<void> recorded = effect.record(cmd, inputs); !recorded.ok()) fail(recorded.error());
  }
}

// The light of the sky, in the engine's own axes: a probe needs no conversion.
void record_ambient(VkCommandBuffer cmd, tyndall::SkyProbe& probe) {
  tyndall::SkyProbeInputs inputs;
  inputs.up = {0.0F, 0.0F, 1.0F};
  inputs.altitude_m = 1000.0F;
  inputs.sun.direction_to_sun = kTowardsSun;
  inputs.sun.irradiance = tyndall::Vec3(1.0F);
  value_or_exit(probe.record(cmd, inputs));
}

void record_frame(VkCommandBuffer cmd, const Images& images, tyndall::Effect& effect, std::uint64_t frame,
                  VkExtent2D extent) {
  const VkClearColorValue black = {};
  const VkClearDepthStencilValue sky = {1.0F, 0};
  const VkImageSubresourceRange color_range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  const VkImageSubresourceRange depth_range = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
  for (const Image& image : {images.color, images.depth, images.output})
    wait_and_move(cmd, image, VK_IMAGE_LAYOUT_UNDEFINED, kGeneral);
  vkCmdClearColorImage(cmd, images.color.image, kGeneral, &black, 1, &color_range);
  vkCmdClearDepthStencilImage(cmd, images.depth.image, kGeneral, &sky, 1, &depth_range);
  wait_and_move(cmd, images.color, kGeneral, kGeneral);
  wait_and_move(cmd, images.depth, kGeneral, kGeneral);
  record_eyes(cmd, images, effect, frame, extent);
  wait_and_move(cmd, images.output, kGeneral, kGeneral);
}

// Records commands, submits them and waits for them.
template <typename Record>
void run(const Device& device, const Record& record) {
  VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  vkResetCommandPool(device.device, device.pool, 0);
  vkBeginCommandBuffer(device.cmd, &begin);
  record(device.cmd);
  vkEndCommandBuffer(device.cmd);
  submit_and_wait(device);
}

// Returns the bytes of a buffer, as floats.
const float* map(const Device& device, const Buffer& buffer) {
  void* data = nullptr;
  need(vkMapMemory(device.device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &data) == VK_SUCCESS, 32);
  return static_cast<const float*>(data);
}

// Returns the largest difference of a channel, relative to the brightest of its pixel, of an eye and a picture of its
// size.
float difference(const float* atlas, std::uint32_t eye, const std::vector<float>& picture) {
  float out = 0.0F;
  for (std::uint32_t y = 0; y < kEye.height; ++y) {
    for (std::uint32_t x = 0; x < kEye.width; ++x) {
      const float* a = atlas + 4 * (y * kAtlas.width + eye * kEye.width + x);
      const float* b = picture.data() + 4 * (y * kEye.width + x);
      const float brightest = std::max({b[0], b[1], b[2], 1e-6F});
      for (int k = 0; k < 3; ++k) out = std::max(out, std::abs(a[k] - b[k]) / brightest);
    }
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const Device device = create_device();
  const Images images = create_images(device, kAtlas);
  const Buffer coefficients = create_buffer(device, 144);
  const Buffer roughest = create_buffer(device, 8);  // a texel of the cube map
  {
    tyndall::Effect effect = create_effect(device);
    tyndall::SkyProbeDesc desc;
    desc.cube_size = 32;
    tyndall::SkyProbe probe = value_or_exit(tyndall::SkyProbe::create(effect, desc));
    run(device, [&](VkCommandBuffer cmd) {
      value_or_exit(effect.record_precompute(cmd));
      record_ambient(cmd, probe);
      record_frame(cmd, images, effect, 0, {48, 27});  // dynamic resolution: three quarters
    });
    run(device, [&](VkCommandBuffer cmd) {
      record_frame(cmd, images, effect, 1, kEye);
      VkBufferImageCopy copy = {};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      copy.imageExtent = {kAtlas.width, kAtlas.height, 1};
      vkCmdCopyImageToBuffer(cmd, images.output.image, kGeneral, images.readback.buffer, 1, &copy);
      const tyndall::SkyCoefficients from = probe.coefficients();
      const VkBufferCopy region = {from.offset, 0, from.size};
      vkCmdCopyBuffer(cmd, from.buffer, coefficients.buffer, 1, &region);
      // The face that looks up, +z, of the level with one texel per face: the irradiance of an upward surface over pi.
      const tyndall::SkyCube cube = probe.cube();
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, cube.levels - 1, 4, 1};
      copy.imageExtent = {1, 1, 1};
      vkCmdCopyImageToBuffer(cmd, cube.image, kGeneral, roughest.buffer, 1, &copy);
    });
  }  // destroys the probe and the effect before the device
  // Evaluate the coefficients as tyndall_sky_irradiance() of tyndall/sky_probe.glsl does, for the normal (0, 0, 1).
  const float* c = map(device, coefficients);
  bool same = true;
  std::uint16_t halves[4] = {};
  std::memcpy(halves, map(device, roughest), sizeof halves);
  std::printf("irradiance from the sky:");
  for (int k = 0; k < 3; ++k) {
    const float e = 3.141593F * 0.282095F * c[k] + 2.094395F * 0.488603F * c[8 + k] + 0.785398F * 0.630783F * c[24 + k];
    const float by_cube = 3.141593F * from_half(halves[k]);
    std::printf(" %g (%g)", static_cast<double>(e), static_cast<double>(by_cube));
    // Both are approximate: the coefficients within 1 %, the texels of the cube map within 0.5 %.
    same = same && std::abs(by_cube / e - 1.0F) < 0.015F;
  }
  std::printf("\n");
  if (argc > 1) {
    std::vector<float> picture(std::size_t{4} * kEye.width * kEye.height);
    std::FILE* file = std::fopen(argv[1], "rb");
    need(file != nullptr && std::fread(picture.data(), 4, picture.size(), file) == picture.size(), 33);
    std::fclose(file);
    const float* atlas = map(device, images.readback);
    for (std::uint32_t eye = 0; eye < 2; ++eye) {
      const float found = difference(atlas, eye, picture);
      std::printf("eye %u differs from the picture of embed by at most %.2g\n", eye, static_cast<double>(found));
      same = same && found < 2e-3F;
    }
  }
  for (const Buffer& buffer : {coefficients, roughest}) {
    vkDestroyBuffer(device.device, buffer.buffer, nullptr);
    vkFreeMemory(device.device, buffer.memory, nullptr);
  }
  destroy(device, images);
  return same ? 0 : 40;
}
