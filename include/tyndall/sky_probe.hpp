// A sky probe: the light of the whole sky around a point, for ambient light and reflections. It is described by
// spherical harmonics of order 2, and optionally by a small cube map; tyndall/sky_probe.glsl evaluates both in your
// shaders.
//
// Contents: the radiance of the sky from every direction above the horizon, and below it that of a ground with
// planet.ground_albedo, lit by sun and sky, seen through the atmosphere. All orders of scattering of the tables,
// without the sun's disc, and without the terrain and shadows of your scene. scattering.single and scattering.multiple
// do not matter. For points inside of the atmosphere.
//
// Coefficients: nine vec4 in a buffer, whose rgb are the integrals of the radiance times the functions of
// tyndall_sky_basis(). The irradiance of surfaces that face up or down is exact. docs/sky_probe.md states the error of
// other normals.
//
// Cube map: RGBA16F, with the radiance in rgb and 1 in alpha. Level 0 holds the radiance at the centres of its texels.
// The others are filtered for reflections in rough surfaces, as Karis, "Real Shading in Unreal Engine 4" (2013): means
// under the lobe of the GGX distribution with alpha = roughness^2, where the view, the normal and the reflected ray
// coincide. The roughness of a level is its number over `levels` - 4, and 1 for the last four. At 1 it is the mean
// under the cosine, the irradiance over pi. Radiance beyond 65504 is clamped, so choose the unit of Sun::irradiance
// accordingly.
//
// A frame:   probe.record(cmd, inputs, budget);   // then a barrier from COMPUTE_SHADER / SHADER_WRITE to your shaders
//
// Conventions, ownership, threads, errors and submission are those of tyndall/effect.hpp. A probe and its effect count
// as one object for threads.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>

#include "tyndall/effect.hpp"

namespace tyndall {

// The point, and the sun. Directions are in any right-handed axes of yours; the coefficients are in the same axes.
struct SkyProbeInputs {
  Vec3 up = {0.0F, 1.0F, 0.0F};  // unit length, away from the planet's centre
  float altitude_m = 0.0F;       // [-planet.radius_m / 4; atmosphere.height_m] - above sea level
  Sun sun;                       // the angular radius is not used
};

// The buffer of the coefficients, a part of nine vec4 of it.
struct SkyCoefficients {
  VkBuffer buffer = VK_NULL_HANDLE;  // can be bound as a storage or a uniform buffer, and copied
  VkDeviceSize offset = 0;           // [bytes]
  VkDeviceSize size = 0;             // [bytes]
};

// The cube map, in layout GENERAL.
struct SkyCube {
  VkImage image = VK_NULL_HANDLE;      // six layers: +x, -x, +y, -y, +z, -z; can also be copied
  VkImageView view = VK_NULL_HANDLE;   // a cube map with all levels
  VkSampler sampler = VK_NULL_HANDLE;  // linear, also between levels
  std::uint32_t size = 0;              // width of a face at level 0 [texels]; 0 without a cube map
  std::uint32_t levels = 0;            // down to one texel per face
};

struct SkyProbeDesc {
  std::uint32_t frames_in_flight = 2;  // [1; 8] - how many calls of record() may be pending
  // 32, 64, 128, or 0 for no cube map [texels] - width of a face. Twice the width takes four times the memory and about
  // four times the slices.
  std::uint32_t cube_size = 0;
};

class TYNDALL_API SkyProbe {
 public:
  // Returns the memory of a probe [bytes]. It is not part of the effect's query_memory().
  static Result<MemoryUsage> query_memory(const DeviceInfo& device, const SkyProbeDesc& desc);
  static Result<MemoryUsage> query_memory(const DeviceInfo& device, std::uint32_t frames_in_flight) {
    return query_memory(device, SkyProbeDesc{frames_in_flight, 0});
  }
  // Makes the pipelines and allocates all memory. The probe uses the effect's tables. Destroy it before the effect,
  // which may be moved. Without a SkyProbeDesc, there is no cube map.
  static Result<SkyProbe> create(Effect& effect, const SkyProbeDesc& desc);
  static Result<SkyProbe> create(Effect& effect, std::uint32_t frames_in_flight = 2) {
    return create(effect, SkyProbeDesc{frames_in_flight, 0});
  }
  // A moved-from SkyProbe can be destroyed or assigned to. Its functions return an error, null or zeros.
  SkyProbe(SkyProbe&&) noexcept;
  SkyProbe& operator=(SkyProbe&&) noexcept;
  // Destroys everything immediately. All recorded commands must have completed.
  ~SkyProbe();

  // Records at most `budget` of the slices of an update, by default all of them. Coefficients and cube map change with
  // the last slice only. The inputs and scattering.scale take effect with the first slice of an update. A call after
  // the last slice begins another update, and so does the first call after other tables have been completed. Returns an
  // error if tables were never built, if scattering.medium is homogeneous, or if the commands of the call
  // frames_in_flight earlier have not completed. Allocates nothing. The last slice waits for all earlier commands of
  // the queue that may read the coefficients or the cube map. Wait for COMPUTE_SHADER / SHADER_WRITE before you read
  // them.
  Result<Progress> record(VkCommandBuffer cmd, const SkyProbeInputs& inputs, std::uint32_t budget = UINT32_MAX);

  // Returns the coefficients. The buffer is the same for the probe's whole life. Its contents are undefined before the
  // first call of record(), and zero until the first update is complete.
  [[nodiscard]] SkyCoefficients coefficients() const;
  // Returns the cube map; null without one. The image is the same for the probe's whole life. It is undefined before
  // the first call of record(), and black until the first update is complete.
  [[nodiscard]] SkyCube cube() const;
  // Returns the memory in use.
  [[nodiscard]] MemoryUsage memory() const;

 private:
  struct State;
  explicit SkyProbe(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tyndall
