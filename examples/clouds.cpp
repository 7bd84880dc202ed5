// Passes the clouds of an engine to Tyndall, so that shafts of light fall through their gaps:
//   * the engine's map of its layer of clouds is bound as FrameInputs::clouds,
//   * the matrix shifts points along the sunlight to the altitude of the layer, where the map is looked up,
//   * the engine shades its ground and draws its clouds by the same map.
// The program draws a view towards a low sun with several layers: clear, broken, overcast, and overcast in the west. It
// fails unless the clear one changes nothing, broken clouds lie between clear and overcast, and the edge of the last
// one is where the plane through sun and camera is. With a name as its argument, it writes NAME.ppm, the picture with
// broken clouds, and NAME_without.ppm, the same scene without FrameInputs::clouds. A second argument, brute-force or
// froxels, chooses the technique.
#include <tyndall/effect.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "vulkan_host.hpp"

namespace {

using namespace host;

constexpr VkExtent2D kExtent = {640, 360};
constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
constexpr float kNear_m = 0.1F;
constexpr float kCamera_m = 250.0F;  // altitude
constexpr float kFocal = 1.1F;       // the picture is 2 / kFocal wide at a distance of 1
constexpr float kRise = 0.2F;        // slope of the ray through its middle, by an off-centre projection
constexpr float kExposure = 8.0F;
constexpr tyndall::Vec3 kToSun = {0.1F, 0.36F, -0.9277F};

// The layer: a square map, north up, whose southern edge is behind the camera.
constexpr std::uint32_t kTexels = 1024;
constexpr float kMap_m = 100000.0F;
constexpr float kMiddleZ_m = -35000.0F;
constexpr float kLayer_m = 2000.0F;
constexpr std::uint8_t kLayerDepth = 128;  // alpha; the depth grows by 1 per kDepth_m
constexpr float kDepth_m = 10000.0F;

// Returns a random number in [0, 1] that varies smoothly over the plane.
float noise(float x, float z) {
  const auto random = [](int i, int k) {
    auto h = static_cast<std::uint32_t>(i) * 0x9E3779B1U ^ static_cast<std::uint32_t>(k) * 0x85EBCA77U;
    h = (h ^ h >> 15U) * 0x2C1B3C6DU;
    h = (h ^ h >> 12U) * 0x297A2D39U;
    return static_cast<float>(h >> 8U) / 16777216.0F;
  };
  const float i = std::floor(x), k = std::floor(z);
  const float a = (x - i) * (x - i) * (3.0F - 2.0F * (x - i)), b = (z - k) * (z - k) * (3.0F - 2.0F * (z - k));
  const int m = static_cast<int>(i), n = static_cast<int>(k);
  return std::lerp(std::lerp(random(m, n), random(m + 1, n), a), std::lerp(random(m, n + 1), random(m + 1, n + 1), a),
                   b);
}

// Returns the fraction of sunlight that broken clouds transmit at a point of the layer. It is 1 at the borders.
float broken(float x, float z) {
  float sum = 0.0F, size_m = 3500.0F, weight = 0.55F;
  for (int octave = 0; octave < 5; ++octave, size_m *= 0.45F, weight *= 0.45F) {
    sum += weight * noise(x / size_m + 37.0F, z / size_m);
  }
  const float border_m = 0.5F * kMap_m - std::max(std::abs(x), std::abs(z - kMiddleZ_m));
  const float cover = std::clamp((sum - 0.4F) / 0.08F, 0.0F, 1.0F) * std::clamp(border_m / 8000.0F, 0.0F, 1.0F);
  return 1.0F - 0.95F * cover * cover * (3.0F - 2.0F * cover);
}

// Returns (u, v, depth) of a point: that of the layer through which its sunlight comes, and how far it is below.
tyndall::Mat4 map_from_world() {
  const float s = 1.0F / kMap_m, d = 1.0F / kDepth_m;
  const float u = -kToSun.x / kToSun.y * s, v = -kToSun.z / kToSun.y * s;  // per metre of altitude
  return {{s, 0, 0, 0, u, v, -d, 0, 0, s, 0, 0, 0.5F - u * kLayer_m, 0.5F - v * kLayer_m - kMiddleZ_m * s,
           static_cast<float>(kLayerDepth) / 255.0F + kLayer_m * d, 1}};
}

// Returns the altitude of the k-th ridge, which runs from west to east.
float ridge_m(int k, float x) {
  const auto row = static_cast<float>(k);
  return row * (90.0F + 600.0F * (noise(x / 4000.0F, 10.0F * row) - 0.5F) + 150.0F * noise(x / 700.0F, 11.0F * row));
}

// Return the slope of the ray through a column or a row of the picture.
float right_of(std::uint32_t x) { return (2.0F * (static_cast<float>(x) + 0.5F) / kExtent.width - 1.0F) / kFocal; }
float up_of(std::uint32_t y) {
  return (1.0F - 2.0F * (static_cast<float>(y) + 0.5F) / kExtent.height) / kFocal * 9.0F / 16.0F + kRise;
}

// Draws a pixel: ridges, ground and clouds, whichever is nearest. (dx, dy) is the slope of its ray. Shading is simple.
void draw_pixel(float dx, float dy, float* color, float& depth) {
  const auto surface = [&](float z_m, float grey, float green) {
    depth = kNear_m / z_m;
    for (int c = 0; c < 3; ++c) color[c] = grey * (c == 1 ? green : 1.0F);
  };
  // Returns the fraction of sunlight that passes the layer on its way to a point.
  const auto sunlight = [](float x, float y, float z) {
    const float up = (kLayer_m - y) / kToSun.y;
    return broken(x + kToSun.x * up, z + kToSun.z * up);
  };
  for (int k = 1; k <= 4; ++k) {
    const float z_m = 4000.0F * static_cast<float>(k * k);
    const float y = kCamera_m + dy * z_m;
    if (y < 0.0F) break;
    if (y < ridge_m(k, dx * z_m)) return surface(z_m, 0.004F + 0.004F * sunlight(dx * z_m, y, -z_m), 1.2F);
  }
  if (dy < 0.0F) {
    const float z_m = -kCamera_m / dy;
    return surface(z_m, 0.006F + 0.012F * sunlight(dx * z_m, 0.0F, -z_m), 1.3F);
  }
  const float z_m = (kLayer_m - kCamera_m) / std::max(dy, 1e-6F);
  const float through = broken(dx * z_m, -z_m);
  if (through < 0.6F) surface(z_m, 0.03F + 0.15F * through, 1.0F);
}

// The opaque scene, which an engine would draw on the device.
struct Scene {
  std::vector<float> color, depth;
};

Scene draw_scene() {
  Scene out;
  out.color.resize(std::size_t{4} * kExtent.width * kExtent.height);
  out.depth.resize(std::size_t{kExtent.width} * kExtent.height);
  for (std::uint32_t y = 0; y < kExtent.height; ++y) {
    for (std::uint32_t x = 0; x < kExtent.width; ++x) {
      const std::size_t i = std::size_t{y} * kExtent.width + x;
      draw_pixel(right_of(x), up_of(y), out.color.data() + 4 * i, out.depth[i]);
    }
  }
  return out;
}

// Returns the texels of a layer: RGBA8, with its depth as alpha.
std::vector<std::uint8_t> draw_map(const std::function<float(float x, float z)>& transmittance) {
  std::vector<std::uint8_t> out;
  for (std::uint32_t k = 0; k < kTexels; ++k) {
    for (std::uint32_t i = 0; i < kTexels; ++i) {
      const auto at = [](std::uint32_t n) { return ((static_cast<float>(n) + 0.5F) / kTexels - 0.5F) * kMap_m; };
      const auto level = static_cast<std::uint8_t>(std::lround(255.0F * transmittance(at(i), at(k) + kMiddleZ_m)));
      out.insert(out.end(), {level, level, level, kLayerDepth});
    }
  }
  return out;
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

void* map(const Device& device, const Buffer& buffer) {
  void* data = nullptr;
  need(vkMapMemory(device.device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &data) == VK_SUCCESS, 32);
  return data;
}

void destroy(const Device& device, const Buffer& buffer) {
  vkDestroyBuffer(device.device, buffer.buffer, nullptr);
  vkFreeMemory(device.device, buffer.memory, nullptr);
}

void destroy(const Device& device, const Image& image) {
  vkDestroyImageView(device.device, image.view, nullptr);
  vkDestroyImage(device.device, image.image, nullptr);
  vkFreeMemory(device.device, image.memory, nullptr);
}

// Fills an image and leaves it in VK_IMAGE_LAYOUT_GENERAL.
template <typename T>
void upload(const Device& device, const Image& image, VkExtent2D extent, const std::vector<T>& texels) {
  const Buffer buffer = create_buffer(device, texels.size() * sizeof(T), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  std::memcpy(map(device, buffer), texels.data(), texels.size() * sizeof(T));
  run(device, [&](VkCommandBuffer cmd) {
    wait_and_move(cmd, image, VK_IMAGE_LAYOUT_UNDEFINED, kGeneral);
    VkBufferImageCopy copy = {};
    copy.imageSubresource = {image.aspect, 0, 0, 1};
    copy.imageExtent = {extent.width, extent.height, 1};
    vkCmdCopyBufferToImage(cmd, buffer.buffer, image.image, kGeneral, 1, &copy);
    wait_and_move(cmd, image, kGeneral, kGeneral);
  });
  destroy(device, buffer);
}

tyndall::Effect create_effect(const Device& device, const std::string& technique) {
  tyndall::EffectDesc desc;
  desc.max_extent = kExtent;
  desc.output_format = tyndall::OutputFormat::rgba32f;
  desc.clouds = true;
  tyndall::Params params;
  params.atmosphere.visibility_m = 20000.0F;
  params.scattering.light_shafts = false;  // because this engine has no shadow maps; clouds do not need them
  params.scattering.multiple = tyndall::MultipleScattering::occluded;  // is darkened by clouds, too
  if (technique == "brute-force") params.scattering.technique = tyndall::Technique::brute_force;
  if (technique == "froxels") params.scattering.technique = tyndall::Technique::froxels;
  return value_or_exit(tyndall::Effect::create(device_info(device), desc, params));
}

void record_frame(VkCommandBuffer cmd, const Images& images, const Image* clouds, tyndall::Effect& effect) {
  value_or_exit(effect.record_precompute(cmd));
  wait_and_move(cmd, images.output, VK_IMAGE_LAYOUT_UNDEFINED, kGeneral);
  tyndall::FrameInputs inputs;
  inputs.extent = kExtent;
  inputs.color = {images.color.view, kGeneral};
  inputs.depth = {images.depth.view, kGeneral};
  inputs.output = {images.output.view, kGeneral};
  inputs.camera.world_from_view.m[13] = kCamera_m;
  const float y = -kFocal * 16.0F / 9.0F;
  inputs.camera.clip_from_view = {{kFocal, 0, 0, 0, 0, y, 0, 0, 0, kRise * y, 0, -1, 0, 0, kNear_m, 0}};
  inputs.sun.direction_to_sun = kToSun;
  inputs.sun.irradiance = tyndall::Vec3(1.0F);
  if (clouds != nullptr) inputs.clouds = {{clouds->view, kGeneral}, map_from_world()};
  if (const tyndall::Result<void> recorded = effect.record(cmd, inputs); !recorded.ok()) fail(recorded.error());
  wait_and_move(cmd, images.output, kGeneral, kGeneral);
  VkBufferImageCopy copy = {};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {kExtent.width, kExtent.height, 1};
  vkCmdCopyImageToBuffer(cmd, images.output.image, kGeneral, images.readback.buffer, 1, &copy);
}

float mean(const std::vector<float>& picture) {
  double sum = 0.0;
  for (std::size_t i = 0; i < picture.size(); ++i) sum += i % 4 != 3 ? static_cast<double>(picture[i]) : 0.0;
  return static_cast<float>(sum / (0.75 * static_cast<double>(picture.size())));
}

// Returns the largest difference of two pictures for pixels on one side of the plane through the camera and the sun:
// east if `side` is positive, west if it is negative, all if it is 0.
float difference(const std::vector<float>& picture, const std::vector<float>& other, float side) {
  float out = 0.0F;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const auto pixel = static_cast<std::uint32_t>(i / 4);
    const float east = right_of(pixel % kExtent.width) - kToSun.x / kToSun.y * up_of(pixel / kExtent.width);
    if (i % 4 != 3 && (side == 0.0F || east * side > 0.2F)) out = std::max(out, std::abs(picture[i] - other[i]));
  }
  return out;
}

// Returns by how much a picture exceeds another one at most.
float excess(const std::vector<float>& picture, const std::vector<float>& other) {
  float out = 0.0F;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    if (i % 4 != 3) out = std::max(out, picture[i] - other[i]);
  }
  return out;
}

// Writes a tone-mapped picture.
void write_ppm(const std::string& path, const std::vector<float>& picture) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  need(file != nullptr, 33);
  std::fprintf(file, "P6\n%u %u\n255\n", kExtent.width, kExtent.height);
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const float display = 1.0F - std::exp(-kExposure * picture[i]);
    if (i % 4 != 3) std::fputc(static_cast<int>(std::lround(255.0F * std::pow(display, 1.0F / 2.2F))), file);
  }
  need(std::fclose(file) == 0, 33);
}

}  // namespace

int main(int argc, char** argv) {
  const Device device = create_device();
  Images images = create_images(device, kExtent);
  const VkImageUsageFlags read = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  destroy(device, images.color);
  images.color = create_image(device, kExtent, VK_FORMAT_R32G32B32A32_SFLOAT, read, VK_IMAGE_ASPECT_COLOR_BIT);
  const Scene scene = draw_scene();
  upload(device, images.color, kExtent, scene.color);
  upload(device, images.depth, kExtent, scene.depth);
  const VkExtent2D texels = {kTexels, kTexels};
  const Image clouds = create_image(device, texels, VK_FORMAT_R8G8B8A8_UNORM, read, VK_IMAGE_ASPECT_COLOR_BIT);
  std::vector<float> none, clear, with, overcast, west;
  {
    tyndall::Effect effect = create_effect(device, argc > 2 ? argv[2] : "epipolar");
    const auto draw = [&](const std::function<float(float x, float z)>& transmittance) {
      if (transmittance) upload(device, clouds, texels, draw_map(transmittance));
      run(device, [&](VkCommandBuffer cmd) { record_frame(cmd, images, transmittance ? &clouds : nullptr, effect); });
      const auto* pixels = static_cast<const float*>(map(device, images.readback));
      std::vector<float> out(pixels, pixels + std::size_t{4} * kExtent.width * kExtent.height);
      vkUnmapMemory(device.device, images.readback.memory);
      return out;
    };
    none = draw(nullptr);
    clear = draw([](float, float) { return 1.0F; });
    with = draw(broken);
    overcast = draw([](float, float) { return 0.05F; });
    // The sunlight of the camera comes through the edge.
    west = draw([](float x, float) { return x < (kLayer_m - kCamera_m) * kToSun.x / kToSun.y ? 0.05F : 1.0F; });
  }  // destroys the effect before the device
  if (argc > 1) {
    write_ppm(std::string(argv[1]) + ".ppm", with);
    write_ppm(std::string(argv[1]) + "_without.ppm", none);
  }
  destroy(device, clouds);
  host::destroy(device, images);
  // Without clouds, scattering is looked up in tables instead of being integrated, so that the pictures differ
  // slightly.
  const float light = mean(none);
  const float changed = difference(clear, none, 0.0F) / light;
  const float outside = std::max(excess(with, clear), excess(overcast, with)) / light;
  const float part = mean(with) / light;
  const float edge = std::max(difference(west, clear, 1.0F), difference(west, overcast, -1.0F)) / light;
  std::printf("clear: %.3f changed, broken: %.2f of the light, %.3f beyond the limits, edge: %.3f\n",
              static_cast<double>(changed), static_cast<double>(part), static_cast<double>(outside),
              static_cast<double>(edge));
  return changed < 0.1F && outside < 0.01F && part > 0.2F && part < 0.5F && edge < 0.1F ? 0 : 40;
}
