// Draws the reflections of a sky probe's cube map: a row of metal spheres, from a mirror on the left to roughness 1 on
// the right, before the sky that the probe sees. It samples the cube map on the host as tyndall_sky_reflection() of
// tyndall/sky_probe.glsl does on the device, and writes the picture to the file (PPM) that its argument names.
#include <tyndall/effect.hpp>
#include <tyndall/sky_probe.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "vulkan_host.hpp"

namespace {

using namespace host;

constexpr std::uint32_t kWidth = 640, kHeight = 160, kSpheres = 5, kCubeSize = 64;
constexpr float kExposure = 6.0F;

struct Rgb {
  float r = 0.0F, g = 0.0F, b = 0.0F;
};
Rgb mix(const Rgb& a, const Rgb& b, float t) {
  return {std::lerp(a.r, b.r, t), std::lerp(a.g, b.g, t), std::lerp(a.b, b.b, t)};
}

float from_half(std::uint16_t half) {
  const float f = static_cast<float>(half % 1024);
  return half < 1024 ? std::ldexp(f, -24) : std::ldexp(f + 1024.0F, half / 1024 - 25);
}

// A place on a face of the cube map: s and t are from -1 to 1, as in the table "Cube map face selection" of the Vulkan
// specification.
struct Place {
  std::uint32_t face = 0;
  float s = 0.0F, t = 0.0F;
};
Place place_of(const tyndall::Vec3& d) {
  const float x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
  if (x >= y && x >= z) return d.x > 0.0F ? Place{0, -d.z / x, -d.y / x} : Place{1, d.z / x, -d.y / x};
  if (y >= z) return d.y > 0.0F ? Place{2, d.x / y, d.z / y} : Place{3, d.x / y, -d.z / y};
  return d.z > 0.0F ? Place{4, d.x / z, -d.y / z} : Place{5, -d.x / z, -d.y / z};
}
tyndall::Vec3 direction_of(const Place& p) {
  switch (p.face) {
    case 0: return {1.0F, -p.t, -p.s};
    case 1: return {-1.0F, -p.t, p.s};
    case 2: return {p.s, 1.0F, p.t};
    case 3: return {p.s, -1.0F, -p.t};
    case 4: return {p.s, -p.t, 1.0F};
    default: return {-p.s, -p.t, -1.0F};
  }
}

// The texels of the cube map on the host: for each level, six faces.
struct Cube {
  std::vector<std::vector<std::uint16_t>> levels;

  // Returns the texel at a place, which may be beyond the edge of its face.
  [[nodiscard]] Rgb texel(std::uint32_t level, const Place& at) const {
    const Place p = place_of(direction_of(at));
    const std::size_t size = std::max(kCubeSize >> level, 1U);
    const auto index = [size](float s) {
      return std::min(static_cast<std::size_t>(0.5F * (s + 1.0F) * static_cast<float>(size)), size - 1);
    };
    const std::uint16_t* const t = levels[level].data() + 4 * ((p.face * size + index(p.t)) * size + index(p.s));
    return {from_half(t[0]), from_half(t[1]), from_half(t[2])};
  }
  // Filters linearly, across the edges of faces too.
  [[nodiscard]] Rgb sample(std::uint32_t level, const Place& p) const {
    const float size = static_cast<float>(std::max(kCubeSize >> level, 1U));
    const float x = 0.5F * (p.s + 1.0F) * size - 0.5F, y = 0.5F * (p.t + 1.0F) * size - 0.5F;
    const auto at = [&](float i, float k) {
      return texel(level, {p.face, (2.0F * i + 1.0F) / size - 1.0F, (2.0F * k + 1.0F) / size - 1.0F});
    };
    const float i = std::floor(x), k = std::floor(y);
    return mix(mix(at(i, k), at(i + 1.0F, k), x - i), mix(at(i, k + 1.0F), at(i + 1.0F, k + 1.0F), x - i), y - k);
  }
  [[nodiscard]] Rgb reflection(const tyndall::Vec3& d, float roughness) const {
    const float level = roughness * static_cast<float>(levels.size() - 4);
    const auto low = static_cast<std::uint32_t>(level);
    return mix(sample(low, place_of(d)), sample(low + 1, place_of(d)), level - static_cast<float>(low));
  }
};

// Copies all levels of the cube map to the host.
Cube read_cube(const Device& device, const tyndall::SkyCube& from) {
  std::vector<VkBufferImageCopy> copies;
  VkDeviceSize bytes = 0;
  Cube out;
  for (std::uint32_t level = 0; level < from.levels; ++level) {
    const std::uint32_t size = std::max(from.size >> level, 1U);
    VkBufferImageCopy copy = {};
    copy.bufferOffset = bytes;
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 6};
    copy.imageExtent = {size, size, 1};
    copies.push_back(copy);
    out.levels.emplace_back(std::size_t{24} * size * size);
    bytes += VkDeviceSize{48} * size * size;
  }
  const Buffer buffer = create_buffer(device, bytes);
  VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  vkResetCommandPool(device.device, device.pool, 0);
  vkBeginCommandBuffer(device.cmd, &begin);
  vkCmdCopyImageToBuffer(device.cmd, from.image, VK_IMAGE_LAYOUT_GENERAL, buffer.buffer, from.levels, copies.data());
  vkEndCommandBuffer(device.cmd);
  submit_and_wait(device);
  void* data = nullptr;
  need(vkMapMemory(device.device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &data) == VK_SUCCESS, 32);
  for (std::uint32_t level = 0; level < from.levels; ++level) {
    std::memcpy(out.levels[level].data(), static_cast<const char*>(data) + copies[level].bufferOffset,
                2 * out.levels[level].size());
  }
  vkDestroyBuffer(device.device, buffer.buffer, nullptr);
  vkFreeMemory(device.device, buffer.memory, nullptr);
  return out;
}

// Returns what a pixel shows: a sphere, seen from the south along parallel rays, or the sky behind it.
Rgb draw_pixel(const Cube& cube, std::uint32_t px, std::uint32_t py) {
  constexpr float kCell = static_cast<float>(kWidth) / kSpheres;
  const float sphere = std::floor(static_cast<float>(px) / kCell);
  const float x = (static_cast<float>(px) + 0.5F - (sphere + 0.5F) * kCell) / (0.45F * kCell);
  const float y = (0.5F * kHeight - static_cast<float>(py) - 0.5F) / (0.45F * kCell);
  const float inside = 1.0F - x * x - y * y;
  if (inside < 0.0F) {
    const float across = 2.0F * static_cast<float>(px) / kWidth - 1.0F;
    return cube.reflection({across, 0.25F * y + 0.1F, -1.0F}, 0.0F);
  }
  const float z = std::sqrt(inside);  // the normal is (x, y, z), and the view looks along -z
  return cube.reflection({2.0F * z * x, 2.0F * z * y, 2.0F * z * z - 1.0F}, sphere / (kSpheres - 1));
}
}  // namespace

int main(int argc, char** argv) {
  const Device device = create_device();
  Cube cube;
  {
    tyndall::EffectDesc desc;
    desc.max_extent = {1, 1};  // nothing is drawn
    tyndall::Params params;
    params.planet.ground_albedo = {0.12F, 0.10F, 0.07F};
    tyndall::Effect effect = value_or_exit(tyndall::Effect::create(device_info(device), desc, params));
    tyndall::SkyProbeDesc probe_desc;
    probe_desc.cube_size = kCubeSize;
    tyndall::SkyProbe probe = value_or_exit(tyndall::SkyProbe::create(effect, probe_desc));
    VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    vkBeginCommandBuffer(device.cmd, &begin);
    value_or_exit(effect.record_precompute(device.cmd));
    tyndall::SkyProbeInputs inputs;
    inputs.altitude_m = 200.0F;
    inputs.sun.direction_to_sun = {0.6F, 0.28F, 0.7494F};  // behind the viewer, so that the spheres show it
    inputs.sun.irradiance = tyndall::Vec3(1.0F);
    value_or_exit(probe.record(device.cmd, inputs));
    vkEndCommandBuffer(device.cmd);
    submit_and_wait(device);
    cube = read_cube(device, probe.cube());
  }  // destroys the probe and the effect before the device
  vkDestroyCommandPool(device.device, device.pool, nullptr);
  vkDestroyDevice(device.device, nullptr);
  vkDestroyInstance(device.instance, nullptr);
  need(argc == 2, 3);
  std::FILE* file = std::fopen(argv[1], "wb");
  need(file != nullptr, 33);
  std::fprintf(file, "P6\n%u %u\n255\n", kWidth, kHeight);
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const Rgb radiance = draw_pixel(cube, i % kWidth, i / kWidth);
    for (const float channel : {radiance.r, radiance.g, radiance.b}) {
      std::fputc(static_cast<int>(std::lround(255.0F * std::pow(1.0F - std::exp(-kExposure * channel), 1.0F / 2.2F))),
                 file);
    }
  }
  return std::fclose(file) == 0 ? 0 : 33;
}
