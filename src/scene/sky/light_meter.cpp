#include "scene/sky/light_meter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "gpu/try.hpp"
#include "math/angles.hpp"
#include "models/spectral.hpp"
#include "tyndall/photometry.hpp"

namespace tyndall::scene {
namespace {

constexpr VkDeviceSize kCoefficientBytes = 9 * 4 * sizeof(float);

// Returns the irradiance of a surface that faces along y, as tyndall_sky_irradiance() of sky_probe.glsl.
Vec3 irradiance_up(const std::array<float, 36>& coefficients) {
  const double weights[] = {0.282094791773878 * kPi, 0.488602511902920 * 2.0 * kPi / 3.0,
                            -0.315391565252520 * kPi / 4.0, -0.546274215296040 * kPi / 4.0};
  constexpr std::size_t kPlaces[] = {0, 1, 6, 8};  // the others are 0 along y
  const auto channel = [&](std::size_t c) {
    double sum = 0.0;
    for (std::size_t i = 0; i < std::size(kPlaces); ++i) {
      sum += weights[i] * static_cast<double>(coefficients[4 * kPlaces[i] + c]);
    }
    return static_cast<float>(sum);
  };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace

Result<LightMeter> LightMeter::create(gpu::Host& host, Effect& effect) {
  TYNDALL_ASSIGN(SkyProbe probe, SkyProbe::create(effect, 1));
  TYNDALL_ASSIGN(gpu::Buffer result, gpu::create_buffer(host.device(), "light_meter", kCoefficientBytes,
                                                        VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::readback));
  return LightMeter(std::move(probe), std::move(result));
}

Result<Illuminance> LightMeter::measure(gpu::Host& host, const Params& params, const Point& point) {
  SkyProbeInputs inputs;
  inputs.altitude_m = static_cast<float>(point.altitude_m);
  const double across = std::sqrt(std::max(1.0 - point.cos_sun_zenith * point.cos_sun_zenith, 0.0));
  inputs.sun.direction_to_sun = {static_cast<float>(across), static_cast<float>(point.cos_sun_zenith), 0.0F};
  inputs.sun.irradiance = point.irradiance;
  const gpu::Device& device = host.device();
  TYNDALL_TRY(host.run([&](VkCommandBuffer cmd) -> Result<void> {
    const Result<Progress> recorded = probe_.record(cmd, inputs);
    if (!recorded) return recorded.error();
    gpu::barrier(device, cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                 VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    const SkyCoefficients from = probe_.coefficients();
    const VkBufferCopy copy = {from.offset, 0, kCoefficientBytes};
    device.vk.CmdCopyBuffer(cmd, from.buffer, result_.buffer.get(), 1, &copy);
    gpu::barrier(device, cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                 VK_ACCESS_HOST_READ_BIT);
    return {};
  }));
  std::array<float, 36> coefficients = {};
  std::memcpy(coefficients.data(), result_.mapped, kCoefficientBytes);
  const std::array<double, 3> color = models::sunlight_color(params, point.altitude_m, point.cos_sun_zenith);
  const auto tinted = [&](std::size_t c, float irradiance) {
    return params.scattering.scale * irradiance * static_cast<float>(color[c]);
  };
  Illuminance out;
  out.sun_lux = point.white_luminance * luminance({tinted(0, point.irradiance.x), tinted(1, point.irradiance.y),
                                                   tinted(2, point.irradiance.z)});
  out.sun_horizontal_lux = out.sun_lux * std::max(point.cos_sun_zenith, 0.0);
  out.sky_lux = point.white_luminance * luminance(irradiance_up(coefficients));
  return out;
}

}  // namespace tyndall::scene
