// Measures updates of a sky probe and frames with clouds, and prints the medians in milliseconds as JSON. Times are
// those from the submission to the completion of the commands. The cases follow one another in each round, so that a
// disturbance of the machine affects all of them.
//
//     library_costs [ROUNDS]
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gpu/host.hpp"
#include "gpu/try.hpp"
#include "tyndall/effect.hpp"
#include "tyndall/sky_probe.hpp"

namespace tyndall {
namespace {

constexpr VkExtent2D kExtent = {1280, 720};
constexpr std::uint32_t kMapTexels = 512;
constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
constexpr Vec3 kToSun = {0.1F, 0.36F, -0.9276F};

// The images of a frame: a level view of the planet's surface under the open sky, and a map of clouds.
struct Images {
  gpu::Image color, depth, output, clouds;
};

Result<gpu::Image> create_filled(gpu::Host& host, const gpu::ImageDesc& desc, const std::vector<std::uint8_t>& bytes) {
  TYNDALL_ASSIGN(gpu::Image image, gpu::create_image(host.device(), desc));
  TYNDALL_TRY(gpu::upload(host, image, bytes.data(), bytes.size(), kGeneral));
  return image;
}

Result<Images> create_images(gpu::Host& host) {
  constexpr VkImageUsageFlags kRead = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const VkExtent3D size = {kExtent.width, kExtent.height, 1};
  const std::size_t pixels = std::size_t{kExtent.width} * kExtent.height;
  Images out;
  TYNDALL_ASSIGN(out.color, create_filled(host, {"color", VK_FORMAT_R16G16B16A16_SFLOAT, size, kRead},
                                          std::vector<std::uint8_t>(8 * pixels)));
  TYNDALL_ASSIGN(out.depth, create_filled(host, {"depth", VK_FORMAT_R32_SFLOAT, size, kRead},
                                          std::vector<std::uint8_t>(4 * pixels)));
  TYNDALL_ASSIGN(out.output, create_filled(host,
                                           {"output", VK_FORMAT_R16G16B16A16_SFLOAT, size,
                                            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT},
                                           std::vector<std::uint8_t>(8 * pixels)));
  // Square clouds of 16 texels, which are 1.6 km.
  std::vector<std::uint8_t> map;
  for (std::uint32_t i = 0; i < kMapTexels * kMapTexels; ++i) {
    const bool cloud = ((i % kMapTexels / 16) ^ (i / kMapTexels / 16)) % 2 == 0;
    const std::uint8_t light = cloud ? 20 : 255;
    map.insert(map.end(), {light, light, light, 128});
  }
  TYNDALL_ASSIGN(out.clouds,
                 create_filled(host, {"clouds", VK_FORMAT_R8G8B8A8_UNORM, {kMapTexels, kMapTexels, 1}, kRead}, map));
  return out;
}

FrameInputs inputs_of(const Images& images, bool clouds) {
  FrameInputs out;
  out.extent = kExtent;
  out.color = {images.color.view.get(), kGeneral};
  out.depth = {images.depth.view.get(), kGeneral};
  out.output = {images.output.view.get(), kGeneral};
  out.camera.world_from_view.m[13] = 500.0F;
  out.camera.clip_from_view = {{1, 0, 0, 0, 0, -16.0F / 9.0F, 0, 0, 0, 0, 0, -1, 0, 0, 0.1F, 0}};
  out.sun.direction_to_sun = kToSun;
  if (!clouds) return out;
  // The layer is at 2 km and is seen from above, as in examples/clouds.cpp.
  constexpr float kScale = 1.0F / 50000.0F, kLayer_m = 2000.0F;
  const float u = -kToSun.x / kToSun.y * kScale, v = -kToSun.z / kToSun.y * kScale;
  out.clouds.map = {images.clouds.view.get(), kGeneral};
  out.clouds.map_from_world = {
      {kScale, 0, 0, 0, u, v, -1e-4F, 0, 0, kScale, 0, 0, 0.5F - u * kLayer_m, 0.9F - v * kLayer_m, 0.7F, 1}};
  return out;
}

struct Case {
  std::string name;
  gpu::Host::Record record;
  std::vector<double> times_ms = {};
};

Result<void> measure(gpu::Host& host, std::vector<Case>& cases, int rounds) {
  for (int round = -1; round < rounds; ++round) {  // the first one is a warm-up
    for (Case& c : cases) {
      const auto start = std::chrono::steady_clock::now();
      TYNDALL_TRY(host.run(c.record));
      const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
      if (round >= 0) c.times_ms.push_back(time.count());
    }
  }
  return {};
}

Result<void> run(int rounds) {
  TYNDALL_ASSIGN(const std::unique_ptr<gpu::Host> host, gpu::Host::create({}));
  DeviceInfo info;
  info.instance = host->device().instance;
  info.physical_device = host->device().physical_device;
  info.device = host->device().device;
  info.get_instance_proc_addr = host->get_instance_proc_addr();
  TYNDALL_ASSIGN(const Images images, create_images(*host));
  EffectDesc desc;
  desc.max_extent = kExtent;
  desc.clouds = true;
  Params params;
  params.scattering.light_shafts = false;
  params.scattering.single = SingleScattering::integration;  // as with clouds
  TYNDALL_ASSIGN(Effect effect, Effect::create(info, desc, params));
  TYNDALL_TRY(host->run([&](VkCommandBuffer cmd) {
    const Result<Progress> built = effect.record_precompute(cmd);
    return built.ok() ? Result<void>() : Result<void>(built.error());
  }));
  std::vector<Case> cases;
  std::uint64_t frame = 0;
  for (const bool clouds : {false, true}) {
    cases.push_back({clouds ? "clouds" : "no_clouds", [&effect, &images, &frame, clouds](VkCommandBuffer cmd) {
                       FrameInputs inputs = inputs_of(images, clouds);
                       inputs.frame_index = frame++;
                       return effect.record(cmd, inputs);
                     }});
  }
  std::vector<SkyProbe> probes;
  for (const std::uint32_t size : {0U, 32U, 64U, 128U}) {
    TYNDALL_ASSIGN(SkyProbe probe, SkyProbe::create(effect, SkyProbeDesc{2, size}));
    probes.push_back(std::move(probe));
    cases.push_back({"sky_probe_" + std::to_string(size), [&probes, i = probes.size() - 1](VkCommandBuffer cmd) {
                       SkyProbeInputs inputs;
                       inputs.sun.direction_to_sun = kToSun;
                       const Result<Progress> recorded = probes[i].record(cmd, inputs);
                       return recorded.ok() ? Result<void>() : Result<void>(recorded.error());
                     }});
  }
  TYNDALL_TRY(measure(*host, cases, rounds));
  std::printf("{");
  for (Case& c : cases) {
    std::sort(c.times_ms.begin(), c.times_ms.end());
    std::printf("%s\"%s\": %.3f", &c == cases.data() ? "" : ", ", c.name.c_str(), c.times_ms[c.times_ms.size() / 2]);
  }
  std::printf("}\n");
  return {};
}

}  // namespace
}  // namespace tyndall

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::max(std::atoi(argv[1]), 1) : 5;
  const tyndall::Result<void> done = tyndall::run(rounds);
  if (!done.ok()) std::fprintf(stderr, "library_costs: error: %s\n", done.error().message.c_str());
  return done.ok() ? 0 : 1;
}
